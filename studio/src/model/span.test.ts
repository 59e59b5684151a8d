import { expect, test } from "vitest";
import { follow, open } from "./span";

test("the span grows at once and shrinks slowly", () => {
  const wide = follow(follow(null, [0, 1]), [-5, 8]);
  expect(wide).toEqual({ lower: -5, upper: 8 });
  const next = follow(wide, [0, 1]);
  expect(next.upper).toBeLessThan(8);
  expect(next.upper).toBeGreaterThan(7);
  expect(next.lower).toBeGreaterThan(-5);
});

test("the span always contains 0, and ignores values that are not finite", () => {
  expect(follow(null, [3, NaN, Infinity, 4])).toEqual({ lower: 0, upper: 4 });
  expect(follow(null, [-3, -Infinity])).toEqual({ lower: -3, upper: 0 });
});

test("an empty span is widened for drawing", () => {
  expect(open(follow(null, [0, 0]))).toEqual({ lower: -1, upper: 1 });
});
