import { expect, it } from "vitest";

import { force } from "./pull";

it("pulls towards the pointer, more the farther it is, and never above the largest force", () => {
  expect(force([0, 0, 0], [0.1, 0, 0])).toEqual([40, 0, 0]);
  const far = force([1, 1, 1], [1, 4, 5]);
  expect(Math.hypot(...far)).toBeCloseTo(100, 9);
  expect(far[2] / far[1]).toBeCloseTo(4 / 3, 9);
  expect(force([1, 2, 3], [1, 2, 3])).toEqual([0, 0, 0]);
});
