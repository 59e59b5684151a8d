import { expect, it } from "vitest";
import type { Kind } from "../../protocol";
import { FollowingColors, middleOf, scaleOf } from "./mapColors";

const LEVELLED = { levels: { charge: { threshold: "theta" } } } as unknown as Kind;

it("a port with levels has a scale with two sides, unless another one is chosen", () => {
  expect(scaleOf("auto", LEVELLED, "charge")).toEqual({ name: "diverging", twoSided: true });
  expect(scaleOf("auto", LEVELLED, "output")).toEqual({ name: "viridis", twoSided: false });
  expect(scaleOf("gray", LEVELLED, "charge")).toEqual({ name: "gray", twoSided: false });
  expect(scaleOf("diverging", undefined, "any")).toEqual({ name: "diverging", twoSided: true });
});

it("the middle of a scale with two sides is the threshold, or 0", () => {
  expect(middleOf(true, [])).toBe(0);
  expect(middleOf(false, [])).toBeNull();
});

it("colours change with the range, the middle and the scale only", () => {
  const colors = new FollowingColors("cividis");
  expect(colors.follow([0, 4], "cividis", null, null)).toBe(true);
  expect(colors.now.range).toEqual([0, 4]);
  expect(colors.follow([1, 3], "cividis", null, null)).toBe(false);
  expect(colors.follow([1, 3], "diverging", 2, null)).toBe(true);
  expect(colors.follow([1, 3], "diverging", 2, [-1, 1])).toBe(true);
  expect(colors.now.range).toEqual([-1, 1]);
});
