import { expect, test } from "vitest";

import { bins, columnsOf, conditionsOf, median, rangeOf, shares, type TrialRow } from "./trialRows";

const row = (trial: number, distance: string, more: Partial<TrialRow> = {}): TrialRow => ({
  trial,
  levels: { distance, preshape: trial % 2 },
  outcome: "seen",
  awaited: "",
  duration: 10 * trial,
  events: { seen: 10 * trial },
  measures: { place: [trial, 2], top: null },
  ...more,
});
const ROWS = [row(0, "near"), row(1, "near"), row(2, "far", { measures: { place: null, top: 3 } })];

test("columns are levels, outcome, duration, events and measures, one for each number", () => {
  const columns = columnsOf(ROWS);
  expect(columns.map(({ name }) => name)).toEqual([
    "distance",
    "preshape",
    "outcome",
    "duration",
    "seen",
    "place.0",
    "place.1",
    "top",
  ]);
  const cells = columns.map(({ of }) => of(ROWS[2] as TrialRow));
  expect(cells).toEqual(["far", 0, "seen", 20, 20, null, null, 3]);
  expect(columnsOf([])).toEqual([]);
});

test("rows of mixed machines have a column of their machine", () => {
  const mixed = [row(0, "near", { machine: "Linux x86_64 A" }), row(1, "near")];
  const last = columnsOf(mixed).at(-1);
  expect(last?.name).toBe("machine");
  expect(mixed.map((one) => last?.of(one))).toEqual(["Linux x86_64 A", null]);
});

test("each combination of levels has its rows", () => {
  expect(conditionsOf(ROWS).map(({ label, short, rows }) => [label, short, rows.length])).toEqual([
    ["distance near, preshape 0", "near, 0", 1],
    ["distance near, preshape 1", "near, 1", 1],
    ["distance far, preshape 0", "far, 0", 1],
  ]);
});

test("bins hold every value, the greatest in the last one", () => {
  expect(bins([0, 0.1, 0.5, 1], [0, 1], 2)).toEqual([2, 2]);
  expect(rangeOf([3, 1, 2])).toEqual([1, 3]);
  expect(bins([7, 7], rangeOf([7, 7]), 3)).toEqual([0, 2, 0]);
  expect(rangeOf([])).toEqual([0, 1]);
});

test("medians and shares", () => {
  expect([median([3, 1, 2]), median([4, 1, 2, 3]), median([])]).toEqual([2, 2.5, null]);
  expect(shares(["a", "b", "a"], ["a", "b", "c"])).toEqual([2, 1, 0]);
});
