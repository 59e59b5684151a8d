import { expect, test } from "vitest";

import { arrowStep, numberText, typedNumber, wrongWith } from "./number";

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

test.each([
  ["", {}, "needs a number"],
  ["", { optional: true }, null],
  ["abc", { optional: true }, "needs a number, not abc"],
  ["2.5", { whole: true }, "needs a whole number, not 2.5"],
  ["1e3", { whole: true }, null],
  ["-1", { lower: 0 }, "must be at least 0"],
  ["0", { lower: 0 }, null],
  ["4294967296", { upper: 4294967295 }, "must be at most 4294967295"],
  ["0,5", { lower: 0.1, upper: 0.5 }, null],
])("%s within %o: %s", (text, limits, wrong) => expect(wrongWith(text, limits)).toBe(wrong));

test.each([
  [6, 1, false, {}, 6.1],
  [0.2, -1, false, {}, 0.19],
  [-60, 1, true, {}, -50],
  [0, 1, false, {}, 0.1],
  [7, 1, false, { whole: true }, 8],
  [7, -1, true, { whole: true, lower: 1 }, 1],
  [99.5, 1, true, { upper: 100 }, 100],
] as const)("%d goes %d, coarse %s, within %o, to %d", (value, direction, coarse, limits, next) =>
  expect(arrowStep(value, direction, coarse, limits)).toBe(next),
);
