import { expect, it } from "vitest";
import type { Announced, AxisView } from "../protocol";
import { allAxes, ends, exchanged, middle, moved, sampleAt } from "./section";

const axis = (name: string, samples = 11, periodic = false): AxisView => ({
  key: name,
  name,
  lower: 0,
  upper: 10,
  samples,
  periodic,
  unit: "",
});

it("the axes of a stream are the drawn ones and the others", () => {
  const form = { axes: [axis("z"), axis("x")], rest: [axis("y")] } as unknown as Announced;
  expect(allAxes(form).map(({ name }) => name)).toEqual(["z", "x", "y"]);
  expect(allAxes(null)).toEqual([]);
});

it("an axis that is drawn already changes places", () => {
  expect(exchanged(["x", "y"], 0, "z")).toEqual(["z", "y"]);
  expect(exchanged(["x", "y"], 0, "y")).toEqual(["y", "x"]);
  expect(exchanged(["x", "y"], 1, "y")).toEqual(["x", "y"]);
});

it("a position is set, moved and removed", () => {
  expect(moved({ z: 1 }, "w", 2)).toEqual({ z: 1, w: 2 });
  expect(moved({ z: 1 }, "z", 3)).toEqual({ z: 3 });
  expect(moved({ z: 1, w: 2 }, "z", null)).toEqual({ w: 2 });
});

it("positions are those of samples", () => {
  expect([-5, 3.4, 99].map((position) => sampleAt(axis("x"), position))).toEqual([0, 3, 10]);
  expect(ends(axis("hue", 4, true))).toEqual([0, 7.5]);
  expect(middle(axis("hue", 4, true))).toBe(5);
});
