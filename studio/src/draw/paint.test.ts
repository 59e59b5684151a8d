import { expect, it } from "vitest";
import { paintCurve } from "./paint";
import { extent } from "./scale";

it("the extent of values ignores values that are not finite", () => {
  expect(extent([3, -1, NaN, Infinity, 2, -Infinity])).toEqual([-1, 3]);
  expect(extent([])).toBeNull();
  expect(extent([NaN])).toBeNull();
});

// What is stroked: the colour, and the rectangle that it is clipped to.
function strokes(lower: number, upper: number, above?: string): unknown[] {
  const stroked: unknown[] = [];
  let clip: number[] | null = null;
  let rect: number[] = [];
  const ctx = {
    strokeStyle: "",
    rect: (...sides: number[]) => (rect = sides),
    clip: () => (clip = rect),
    restore: () => (clip = null),
    stroke: () => stroked.push([ctx.strokeStyle, clip]),
    save() {},
    beginPath() {},
    moveTo() {},
    lineTo() {},
  };
  const how = { width: 40, height: 100, lower, upper, color: "blue", lineWidth: 2, ...(above && { above }) };
  paintCurve(ctx as unknown as CanvasRenderingContext2D, [-1, 3], how);
  return stroked;
}

it("a curve has one colour below 0 and another one above it", () => {
  expect(strokes(-1, 3, "ember")).toEqual([
    ["blue", [-2, 75, 44, 27]],
    ["ember", [-2, -2, 44, 77]],
  ]);
  expect(strokes(0, 3, "ember")).toEqual([["ember", null]]);
  expect(strokes(-3, 0, "ember")).toEqual([["blue", null]]);
  expect(strokes(-1, 3)).toEqual([["blue", null]]);
});
