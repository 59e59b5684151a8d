import { expect, test } from "vitest";

import { timeWindows } from "./timeWindows";

test("windows have a start and a stop, and one of the default lasts", () => {
  const windows = [
    { kind: "Window", start: 100, stop: 400 },
    { kind: "Window", start: 700, stop: 1e30 },
  ];
  expect(timeWindows({ windows })).toEqual([
    [100, 400],
    [700, 1e30],
  ]);
});

test("an element without windows has none", () => {
  expect(timeWindows({})).toEqual([]);
  expect(timeWindows({ windows: [] })).toEqual([]);
  expect(timeWindows({ windows: null })).toEqual([]);
});
