import { expect, test } from "vitest";
import { fakeElement } from "./fakes";
import { FOLDED, FRAME, places } from "./layout";
import type { Point, Rect } from "../model/rects";
import { meet } from "../model/rects";
import { tree } from "./tree";

const SIZE = { width: 100, height: 50 };

function laid(
  paths: string[],
  bonds: [string, string][],
  boxes: Record<string, Point> = {},
  folded: string[] = [],
) {
  const found = tree(
    paths.map((path) => fakeElement(path)),
    [],
    folded,
    new Set(),
  );
  const sizes = new Map(paths.map((path) => [path, SIZE]));
  const where = places(
    found.root,
    sizes,
    bonds.map(([source, target]) => ({ source, target, room: 0 })),
    new Map(Object.entries(boxes)),
  );
  const at = (id: string) => where.elements.get(id) ?? { x: NaN, y: NaN };
  return { ...where, at };
}

test("connected elements are placed from left to right", () => {
  const { at } = laid(
    ["b", "a", "c"],
    [
      ["a", "b"],
      ["b", "c"],
    ],
  );
  expect(at("a").x + SIZE.width).toBeLessThan(at("b").x);
  expect(at("b").x + SIZE.width).toBeLessThan(at("c").x);
});

test("boxes keep the positions of the document, and the others are placed beside them", () => {
  const boxes = { a: { x: 1000, y: 500 }, b: { x: 1200, y: 500 } };
  const { at } = laid(
    ["a", "b", "c"],
    [
      ["a", "b"],
      ["b", "c"],
    ],
    boxes,
  );
  expect([at("a"), at("b")]).toEqual([boxes.a, boxes.b]);
  expect(at("c").x).toBeGreaterThan(1250);
  expect(Math.abs(at("c").y - 500)).toBeLessThan(100);
});

test("a box without a position never overlaps a box with one", () => {
  const { at } = laid(["a", "b", "c"], [], { a: { x: 0, y: 0 }, b: { x: 0, y: 60 } });
  const rects = ["a", "b", "c"].map((id) => ({ ...at(id), ...SIZE }));
  expect(rects.some((one, i) => rects.some((other, j) => i < j && meet(one, other)))).toBe(false);
});

test("the frame of a group contains its elements", () => {
  const { at, groups } = laid(
    ["g.a", "g.h.b", "c"],
    [
      ["g.a", "g.h.b"],
      ["g.h.b", "c"],
    ],
  );
  const [outer, inner] = [groups.get("g") as Rect, groups.get("g/h") as Rect];
  expect(outer.x + FRAME.side).toBeLessThanOrEqual(at("g.a").x);
  expect(outer.x + outer.width).toBeGreaterThanOrEqual(inner.x + inner.width + FRAME.side);
  expect(inner.y + FRAME.top).toBeLessThanOrEqual(at("g.h.b").y);
  expect(at("c").x).toBeGreaterThan(outer.x + outer.width);
});

test("a folded group has the size of a box, and its elements keep their positions", () => {
  const { at, groups } = laid(
    ["g.a", "g.b", "c"],
    [
      ["g.a", "g.b"],
      ["g.b", "c"],
    ],
    {},
    ["g"],
  );
  expect(groups.get("g")).toMatchObject(FOLDED);
  expect(at("g.b").x - at("g.a").x).toBeGreaterThan(SIZE.width);
});

test("an unfolded group moves the boxes that it would cover", () => {
  const boxes = { "g.a": { x: 100, y: 100 }, "g.b": { x: 400, y: 100 }, c: { x: 320, y: 100 } };
  const open = laid(["g.a", "g.b", "c"], [], boxes);
  expect(meet(open.groups.get("g") as Rect, { ...open.at("c"), ...SIZE })).toBe(false);
  expect(laid(["g.a", "g.b", "c"], [], boxes, ["g"]).at("c")).toEqual(boxes.c);
});

test("cycles are laid out too", () => {
  const { at } = laid(
    ["a", "b"],
    [
      ["a", "b"],
      ["b", "a"],
      ["a", "a"],
    ],
  );
  expect(Math.abs(at("a").x - at("b").x)).toBeGreaterThanOrEqual(SIZE.width);
});
