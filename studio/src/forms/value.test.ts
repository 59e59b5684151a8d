import { expect, test } from "vitest";

import { typedValue, valueText } from "./value";

test("numbers, flags and lists are read as such, and the rest is text", () => {
  expect(["-5", "0.5", "1e3", "true", "[1, 2]"].map(typedValue)).toEqual([-5, 0.5, 1000, true, [1, 2]]);
  expect([" above ", "left.center", ""].map(typedValue)).toEqual(["above", "left.center", null]);
});

test("a value is shown as it is typed", () => {
  for (const text of ["-5", "0.5", "true", "[1,2]", "above", ""])
    expect(valueText(typedValue(text))).toBe(text);
  expect(valueText(undefined)).toBe("");
});
