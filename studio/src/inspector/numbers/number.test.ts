import { expect, test } from "vitest";

import { numberText, typedNumber } from "./number";

test.each([
  [0, "0"],
  [20, "20"],
  [-5.5, "-5.5"],
  [0.1 + 0.2, "0.3"],
  [1e-6, "1e-6"],
  [1e30, "1e30"],
  [1.25e-7, "1.25e-7"],
  [123456.789, "123457"],
  [1000000, "1000000"],
])("%d is shown as %s", (value, text) => expect(numberText(value)).toBe(text));

test.each([
  ["3", 3],
  [" -0,5 ", -0.5],
  ["1e-6", 1e-6],
  ["−2", -2],
  ["", null],
  ["abc", null],
  ["1,2,3", null],
  ["Infinity", null],
])("%s is read as %s", (text, value) => expect(typedNumber(text)).toBe(value));
