import { expect, it } from "vitest";

import { SPEEDS, stopOf } from "./speeds";

it("each stop is the nearest stop of its own speed", () => {
  SPEEDS.forEach((speed, i) => expect(stopOf(speed)).toBe(i));
});

it("other speeds take the stop of the nearest ratio", () => {
  expect(SPEEDS[stopOf(1.3)]).toBe(1);
  expect(SPEEDS[stopOf(1.5)]).toBe(2);
  expect(SPEEDS[stopOf(0.001)]).toBe(0.01);
  expect(SPEEDS[stopOf(500)]).toBe(10);
});
