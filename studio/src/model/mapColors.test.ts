import { expect, it } from "vitest";
import type { Kind } from "../protocol";
import { amounts, scale } from "./colors";
import { FollowingColors, middleOf, scaleOf } from "./mapColors";

const LEVELLED = { levels: { charge: { threshold: "theta" } } } as unknown as Kind;

it("a port with levels has a scale with two sides, unless another one is chosen", () => {
  expect(scaleOf("auto", LEVELLED, "charge")).toEqual({ tables: scale("diverging"), twoSided: true });
  expect(scaleOf("auto", LEVELLED, "output")).toEqual({ tables: amounts("output"), twoSided: false });
  expect(scaleOf("gray", LEVELLED, "charge")).toEqual({ tables: scale("gray"), twoSided: false });
  expect(scaleOf("diverging", undefined, "any")).toEqual({ tables: scale("diverging"), twoSided: true });
});

it("the middle of a scale with two sides is the threshold, or 0", () => {
  expect(middleOf(true, [])).toBe(0);
  expect(middleOf(false, [])).toBeNull();
});

it("colours change with the range, the middle and the scale only", () => {
  const colors = new FollowingColors();
  const [one, both] = [scaleOf("cividis", undefined, "w"), scaleOf("diverging", undefined, "w")];
  expect(colors.follow([0, 4], one, null, null)).toBe(true);
  expect(colors.now.range).toEqual([0, 4]);
  expect(colors.follow([1, 3], one, null, null)).toBe(false);
  expect(colors.follow([1, 3], both, 2, null)).toBe(true);
  expect(colors.follow([1, 3], both, 2, [-1, 1])).toBe(true);
  expect(colors.now.range).toEqual([-1, 1]);
});
