import { expect, test } from "vitest";

import { ALIGNMENTS, type Boxes } from "./aligning";

const boxes: Boxes = new Map([
  ["a", { x: 0, y: 0, width: 100, height: 50 }],
  ["b", { x: 130, y: 40, width: 100, height: 100 }],
  ["c", { x: 400, y: 90, width: 200, height: 60 }],
]);
const by = (does: string) => {
  const moved = ALIGNMENTS.find((alignment) => alignment.does === does)?.moved(boxes);
  return [...(moved ?? [])].map(([id, { x, y }]) => [id, x, y]);
};

test("boxes are aligned at an edge or by their middles", () => {
  expect(by("Align left edges")).toEqual([
    ["a", 0, 0],
    ["b", 0, 40],
    ["c", 0, 90],
  ]);
  expect(by("Align right edges")).toEqual([
    ["a", 500, 0],
    ["b", 500, 40],
    ["c", 400, 90],
  ]);
  expect(by("Align bottom edges")).toEqual([
    ["a", 0, 100],
    ["b", 130, 50],
    ["c", 400, 90],
  ]);
  expect(by("Align in a row, by their middles")).toEqual([
    ["a", 0, 50],
    ["b", 130, 25],
    ["c", 400, 45],
  ]);
});

test("distributed boxes have equal gaps, and the outer ones stay", () => {
  expect(by("Distribute horizontally")).toEqual([
    ["a", 0, 0],
    ["b", 200, 40],
    ["c", 400, 90],
  ]);
});
