import { expect, test } from "vitest";

import { COLUMNS, STRIP_COLORS, STRIP_RANGE, STRIP_TIME, stripOf } from "./strip";

const LEVELS = [
  { label: "threshold", value: 1 },
  { label: "resting level", value: -4 },
];
// The time in the middle of a column, where the first sample is at 0.
const at = (column: number) => ((column + 0.5) * STRIP_TIME) / COLUMNS;

test("a sample holds until the next, in distances from the threshold to the resting level", () => {
  const samples = { times: [0, at(3), at(6)], values: [-4, 1, 6] };
  const { columns = new Float32Array(), newest, above } = stripOf(samples, Infinity, LEVELS) ?? {};
  expect([...columns.slice(0, 8)]).toEqual([-1, -1, -1, 0, 0, 0, 1, NaN]);
  expect([newest, above]).toEqual([6, true]);
});

test("a column has the greatest of its samples", () => {
  const samples = { times: [0, at(2) - 1, at(2), at(2) + 1], values: [-4, 1, 6, -4] };
  expect(stripOf(samples, Infinity, LEVELS)?.columns[2]).toBe(1);
  expect(stripOf(samples, Infinity, LEVELS)?.above).toBe(false);
});

test("the newest times are shown, the last sample at the right end", () => {
  const times = Array.from({ length: 500 }, (_, i) => i * 10);
  const values = times.map((time) => (time < 4000 ? -4 : 6));
  const { columns = new Float32Array() } = stripOf({ times, values }, Infinity, LEVELS) ?? {};
  const switched = Math.floor((COLUMNS * (4000 - (4990 - STRIP_TIME))) / STRIP_TIME);
  expect([...new Set(columns.slice(0, switched))]).toEqual([-1]);
  expect([...new Set(columns.slice(switched))]).toEqual([1]);
});

test("what comes after the time shown is not shown", () => {
  const samples = { times: [0, at(3), at(6)], values: [-4, 1, 6] };
  const past = stripOf(samples, at(4), LEVELS);
  expect([past?.newest, past?.above, past?.columns[6]]).toEqual([1, false, NaN]);
  expect(stripOf(samples, -1, LEVELS)).toBeNull();
});

test("without samples or a threshold there is no strip", () => {
  expect(stripOf({ times: [], values: [] }, Infinity, LEVELS)).toBeNull();
  expect(stripOf({ times: [0], values: [1] }, Infinity, [])).toBeNull();
});

test("the threshold is white, and below and above it no colour is", () => {
  const [lower, upper] = STRIP_RANGE;
  const color = (level: number) => {
    const i = Math.floor((255 * (level - lower)) / (upper - lower) + 0.5);
    return [...STRIP_COLORS.slice(4 * i, 4 * i + 3)];
  };
  expect(color(0)).toEqual([255, 255, 255]);
  const [red = 0, , blue = 0] = color(-1);
  expect(blue).toBeGreaterThan(red);
  const [emberRed = 0, , emberBlue = 0] = color(1);
  expect(emberRed).toBeGreaterThan(emberBlue);
});
