import { expect, it } from "vitest";

import { type Kept, lateText, meterLines, millisecondsText } from "./meter";

const good: Kept = {
  running: true,
  speed: 1,
  dt: 1,
  steps: 1000,
  lag: 0.3,
  worst: 4,
  lost: 0,
  overruns: 0,
  longest: null,
  lengthened: 0,
};

it("a run in real time has no lag", () => {
  expect(lateText(good)).toBe("");
  expect(meterLines("Pace", good, "ms")).toEqual([
    "Pace",
    "1000 steps in a second",
    "Behind by 0.3 ms, at most 4.0 ms since it was played",
    "Never fell behind",
  ]);
});

it("a run that is too slow reports its lag, how often it fell behind, and the skipped time", () => {
  const late = { ...good, lag: 250, worst: 260.2, lost: 12_345, overruns: 3 };
  expect(lateText(late)).toBe("250 ms late");
  const lines = meterLines("Pace", late, "ms");
  expect(lines[2]).toBe("Behind by 250 ms, at most 260 ms since it was played");
  expect(lines.slice(3)).toEqual(["Fell behind 3 times", "12 s were skipped and will not be caught up"]);
  expect(meterLines("Pace", { ...late, overruns: 1 }, "ms")[3]).toBe("Fell behind once");
});

it("lengthened steps are reported", () => {
  expect(meterLines("Pace", { ...good, lengthened: 12_000, dt: 3 }, "ms").at(-1)).toBe(
    "12\u2009000 steps were lengthened; now they are 3 ms",
  );
  expect(meterLines("Pace", { ...good, lengthened: 5, dt: 3 }, "abstract").at(-1)).toBe(
    "5 steps were lengthened; now they are 3",
  );
});

it("a run at full speed and a paused run have no lag", () => {
  expect(lateText({ ...good, speed: null, lag: 500 })).toBe("");
  expect(lateText({ ...good, running: false, lag: 500 })).toBe("");
  expect(meterLines("Pace", { ...good, speed: null }, "ms")).toEqual(["Pace", "1000 steps in a second"]);
  expect(meterLines("Pace", { ...good, running: false }, "ms")).toEqual(["Pace"]);
});

it("wall times are rounded", () => {
  expect([0, 9.94, 9.96, 250.4, 9999, 10_000, 3_600_000].map(millisecondsText)).toEqual([
    "0.0 ms",
    "9.9 ms",
    "10 ms",
    "250 ms",
    "9999 ms",
    "10 s",
    "3600 s",
  ]);
});
