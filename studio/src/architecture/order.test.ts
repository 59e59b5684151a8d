import { expect, test } from "vitest";

import { fakeCosivina, fakeDocument, fakeElement, fakeKind, kindsOf } from "./fakes";
import { PANEL } from "./layout";
import { canvasOrder } from "./order";
import { scene } from "./scene";
import type { Structure } from "./contract";

const KINDS = kindsOf(
  fakeKind("Field", "elements"),
  fakeKind("GaussianStimulus", "elements"),
  fakeKind("Noise", "elements", { equation: ["\\xi"] }),
  fakeKind("Gain", "couplings"),
);
const GRID = fakeCosivina("presetSceneRepresentation.json");

const named = (structure: Structure) =>
  canvasOrder(structure, KINDS).map(
    ({ title, elements }) => [title, elements.map(({ name }) => name)] as const,
  );

test("on the grid: frame by frame from the left, in a frame row by row", () => {
  const { places } = scene(GRID, KINDS, PANEL);
  const at = (name: string) => places.elements.get(name) ?? { x: NaN, y: NaN };
  const frames = named(GRID).filter(([title]) => title !== "");
  expect(frames).toHaveLength(3);
  expect(frames.flatMap(([, names]) => names)).toHaveLength(20);
  const lefts = frames.map(([, names]) => Math.min(...names.map((name) => at(name).x)));
  expect(lefts).toEqual(lefts.toSorted((a, b) => a - b));
  for (const [, names] of frames) {
    const reading = names.toSorted((a, b) => at(a).y - at(b).y || at(a).x - at(b).x);
    expect(names).toEqual(reading);
  }
  expect(frames.map(([title]) => title.split(" ").toSorted())).toContainEqual(["c1", "f1"]);
});

test("the order has every element once", () => {
  const names = named(GRID).flatMap(([, all]) => all);
  expect(names.toSorted()).toEqual(GRID.elements.map(({ name }) => name).toSorted());
});

test("without a grid: as in the document, group by group", () => {
  const elements = ["b", "two.d", "a", "one.c", "two.in.e", "two.f"].map((path) => fakeElement(path));
  const groups = [["two"], ["one"], ["two", "in"]];
  expect(named(fakeDocument(elements, [], { groups }))).toEqual([
    ["", ["b", "a"]],
    ["two", ["d", "f"]],
    ["two/in", ["e"]],
    ["one", ["c"]],
  ]);
});
