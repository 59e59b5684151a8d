import { expect, test } from "vitest";

import { arrayText } from "./ArrayForm";
import { axisOption } from "./AxesForm";

test.each([
  [{ shape: [3, 4], min: -1, max: 2.5 }, "3 × 4 numbers, -1 to 2.5"],
  [{ shape: [7] }, "7 numbers"],
  [{ array: "f00d" }, "f00d"],
  [null, "none"],
])("%j reads %s", (value, text) => expect(arrayText(value)).toBe(text));

test("an axis in a menu shows its name if its key differs", () => {
  const axis = { key: "x", name: "x", lower: 0, upper: 100, samples: 101, periodic: false, unit: "deg" };
  expect(axisOption(axis)).toEqual({ value: "x", label: "x: 0 to 100 deg, 101 samples" });
  expect(axisOption({ ...axis, key: "x_2", unit: "" }).label).toBe("x_2 (x): 0 to 100, 101 samples");
});
