import { expect, it } from "vitest";
import type { AxisView } from "../../protocol";
import { surfaceSize, volumeSize } from "./sceneSize";

// A length with a sample at each unit.
const axis = (name: string, samples: number, unit = "cm"): AxisView => ({
  key: name,
  name,
  lower: 0,
  upper: samples - 1,
  samples,
  periodic: false,
  unit,
});
const [x, y, z, angle] = [axis("x", 20), axis("y", 10), axis("z", 5), axis("angle", 5, "deg")];

it("axes of a surface that share a unit have the same scale", () => {
  expect(surfaceSize(x, y)).toEqual([1, 0.5, 0.5]);
  expect(surfaceSize(y, x)).toEqual([0.5, 1, 0.5]);
  expect(surfaceSize(x, angle)).toEqual([1, 1, 0.5]);
});

it("a volume is a cube unless all its axes share a unit", () => {
  expect(volumeSize(x, y, z)).toEqual([0.8, 0.4, 0.2]);
  expect(volumeSize(x, y, angle)).toEqual([0.8, 0.8, 0.8]);
});
