import { expect, it } from "vitest";
import type { AxisView } from "../protocol";
import type { Live } from "../streams";
import { readPlane } from "./readPlane";

const axis = (name: string, samples: number): AxisView => ({
  key: name,
  name,
  lower: 0,
  upper: samples - 1,
  samples,
  periodic: false,
  unit: "",
});

const live = { form: { shape: [2, 3] }, frame: { values: Float32Array.from([0, 1, 2, 3, 9, 5]) } };

it("a cursor on both axes reads a value, one on a single axis the maximum over the other", () => {
  const read = (x: number | null, y: number | null) =>
    readPlane(live as unknown as Live, axis("x", 2), axis("y", 3), { x, y });
  expect(read(1, 2)).toBe("x 1.000   y 2.000   5.000");
  expect(read(0, null)).toBe("x 0.000   max 2.000");
  expect(read(null, 0)).toBe("y 0.000   max 3.000");
  expect(readPlane(null, axis("x", 2), axis("y", 3), { x: 0, y: 0 })).toBe("");
});
