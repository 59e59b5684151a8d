import { expect, test } from "vitest";

import { motorText } from "./motorText";

test("a motor has its range and its greatest change a second", () => {
  const left = { motor: "left", lower: -5, upper: 5, unit: "rad/s" };
  expect(motorText(left)).toBe("left: -5 to 5 rad/s");
  expect(motorText({ ...left, slew: 20 })).toBe("left: -5 to 5 rad/s, at most 20 a second");
  expect(motorText({ motor: "turn", slew: 2 })).toBe("turn: any value, at most 2 a second");
  expect(motorText({ motor: "turn", lower: null, upper: null, slew: null })).toBe("turn: any value");
});
