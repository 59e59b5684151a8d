import { describe, expect, test } from "vitest";

import type { AxisView } from "../protocol";
import { unitText } from "./unit";

const axis = (unit: string): AxisView => ({
  key: "x",
  name: "x",
  lower: 0,
  upper: 1,
  samples: 2,
  periodic: false,
  unit,
});

describe("units as they are shown", () => {
  test.each([
    ["time", "ms", "ms"],
    ["time", "us", "µs"],
    ["time", "abstract", ""],
    ["time", "1 = 64 ms", "× 64 ms"],
    ["axis", "ms", "deg"],
    ["activation", "ms", ""],
    ["1/activation", "ms", ""],
    ["motor/axis", "ms", "motor/deg"],
    ["motor/time", "s", "motor/s"],
    ["time x input", "ms", "ms × input"],
    ["input x axis", "ms", "input × deg"],
    ["1/time", "ms", "1/ms"],
    ["hue", "ms", "hue"],
    ["", "ms", ""],
  ])("%s in %s", (unit, time, text) => expect(unitText(unit, time, [axis("deg")])).toBe(text));

  test("axes of different units have no common unit", () => {
    expect(unitText("axis", "ms", [axis("deg"), axis("deg")])).toBe("deg");
    expect(unitText("axis", "ms", [axis("deg"), axis("cm")])).toBe("");
    expect(unitText("motor/axis", "ms", [])).toBe("motor");
  });
});
