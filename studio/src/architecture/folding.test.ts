import { expect, test } from "vitest";
import type { LayoutView } from "../protocol";
import { useStudio } from "../server/store";
import { fakeConnections, fakeDocument, fakeElement } from "./fakes";
import { firstFolded, foldedNow, useOpening, withFolded } from "./folding";
import { PANEL } from "./layout";
import { scene } from "./scene";

// Four groups of `count` elements in a chain, each with a group of its own inside.
function chained(count: number, layout: Partial<LayoutView> = {}) {
  const names = ["a", "b", "c", "d"].flatMap((group) =>
    Array.from({ length: count }, (_, i) => `${group}.${i % 3 === 0 ? "in." : ""}u${i}`),
  );
  const elements = names.map((name) => fakeElement(name));
  return fakeDocument(elements, fakeConnections(names.join(" ")), { layout });
}

test("a small document opens with every group open", () => {
  expect(firstFolded(chained(1), new Map(), PANEL)).toEqual([]);
});

test("groups fold from inside out, as far as names need it", () => {
  expect(firstFolded(chained(9), new Map(), PANEL)).toContain("a");
  const wide = firstFolded(chained(9), new Map(), { width: 4000, height: 1600 });
  expect(wide).toEqual([]);
});

test("a layout that the document stores wins", () => {
  expect(firstFolded(chained(9, { folded: ["b"] }), new Map(), PANEL)).toEqual(["b"]);
  expect(firstFolded(chained(9, { boxes: { x: { x: 1, y: 1 } } }), new Map(), PANEL)).toEqual([]);
  useOpening.setState({ folded: ["a"] });
  useStudio.setState({ document: chained(9) });
  expect(foldedNow()).toEqual(["a"]);
  useStudio.setState({ document: chained(9, { folded: [] }) });
  expect(foldedNow()).toEqual([]);
});

test("groups that were folded at the start are boxes of the scene", () => {
  const shown = scene(withFolded(chained(3), ["a", "a/in"]), new Map());
  expect(shown.nodes.filter((node) => node.type === "folded").map((node) => node.id)).toEqual(["group:a"]);
});
