import { expect, it } from "vitest";
import { nearestIndex, nearestPlace, nearestTime } from "./cursorText";

it("the nearest sample of a trajectory is found by time and by position", () => {
  const found = { times: [0, 1, 2], xs: [0, 10, 0], ys: [0, 0.5, 1] };
  const sides = [{ range: [0, 10] }, { range: [0, 1] }] as const;
  expect(nearestTime(found, 1.4)).toBe(1);
  expect(nearestPlace(found, [1, 0.9], sides)).toBe(2);
  expect(nearestTime({ times: [] }, 1)).toBe(-1);
});

it("the nearest of positions in order is found, also beyond the ends", () => {
  const nearest = (value: number) => nearestIndex([0, 1, 4], value);
  expect([-5, 0.4, 0.6, 2.4, 2.6, 9].map(nearest)).toEqual([0, 0, 1, 1, 2, 2]);
  expect(nearestIndex([7], 1)).toBe(0);
  expect(nearestIndex([], 1)).toBe(-1);
});
