import { expect, it } from "vitest";
import { extent } from "./paint";

it("the extent of values ignores values that are not finite", () => {
  expect(extent([3, -1, NaN, Infinity, 2, -Infinity])).toEqual([-1, 3]);
  expect(extent([])).toBeNull();
  expect(extent([NaN])).toBeNull();
});
