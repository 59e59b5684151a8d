import { expect, test } from "vitest";

import { applied } from "./applied";
import { fakeConnections, fakeDocument, fakeElement } from "../architecture/fakes";
import type { DocumentView, KeyedDifference } from "../protocol";
import { useStudio } from "./store";

const [u, v, w] = [
  fakeElement("u"),
  fakeElement("v", "Field", { values: { tau: 5, kernel: [] } }),
  fakeElement("w"),
];
const document = fakeDocument([u, v], fakeConnections("u v"));

test("an empty difference keeps every part", () => {
  const next = applied(document, { changed: { undo: 4 } });
  expect(next).toEqual({ ...document, undo: 4 });
  expect(Object.entries(next).filter(([key, part]) => part !== document[key as keyof DocumentView])).toEqual([
    ["undo", 4],
  ]);
});

test("a value of one element changes, and all beside it stays the same object", () => {
  const inside = { elements: { inside: { 1: { inside: { values: { changed: { tau: 7 } } } } } } };
  const next = applied(document, { inside });
  expect(next.elements).toEqual([u, { ...v, values: { tau: 7, kernel: [] } }]);
  expect(next.elements[0]).toBe(u);
  expect(next.elements[1]?.axes).toBe(v.axes);
  expect(next.elements[1]?.values["kernel"]).toBe(v.values["kernel"]);
  expect(next.connections).toBe(document.connections);
  expect(v.values["tau"], "the document before").toBe(5);
});

test("entries of a list are removed by their index before, and inserted at that after the edit", () => {
  const x = fakeElement("x");
  const next = applied(document, { inside: { elements: { removed: ["0"], changed: { 2: x, 0: w } } } });
  expect(next.elements.map(({ id }) => id)).toEqual(["w", "v", "x"]);
  expect(next.elements[1]).toBe(v);
});

test("entries of an object are removed, replaced and added by their keys", () => {
  const before = { boxes: { "12": { x: 1 }, u: { x: 2 }, v: { x: 3 } }, folded: ["g"] };
  const boxes = { removed: ["u"], inside: { v: { changed: { x: 4 } } }, changed: { w: { x: 5 } } };
  const next = applied(before, { inside: { boxes } });
  expect(next.boxes).toEqual({ "12": { x: 1 }, v: { x: 4 }, w: { x: 5 } });
  expect(next.boxes["12"]).toBe(before.boxes["12"]);
  expect(next.folded).toBe(before.folded);
  expect(before.boxes.u).toEqual({ x: 2 });
});

test("a removed element is no longer selected in the store, and the others keep their entries", () => {
  const { take, select } = useStudio.getState();
  const edited = (version: number, difference: KeyedDifference) =>
    take({ type: "edited", version, difference, cost: "recompile" });
  take({ type: "opened", session: 1, version: 1, document });
  const { elements } = useStudio.getState();
  edited(2, { changed: { title: "another" } });
  expect(useStudio.getState().elements, "no element changed").toBe(elements);
  select(["u", "v"]);
  edited(7, { inside: { elements: { removed: ["0"] } } });
  const state = useStudio.getState();
  expect(state.version).toBe(7);
  expect(state.selected).toEqual(["v"]);
  expect([...state.elements.values()]).toEqual([v]);
  expect(state.elements.get("v")).toBe(v);
});
