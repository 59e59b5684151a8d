import { expect, test } from "vitest";

import { columnsOf } from "./TileGrid";

test("a grid has as few rows as tiles of 300 px allow, and these are even", () => {
  expect(columnsOf(1120, 9)).toBe(3);
  expect(columnsOf(1120, 4)).toBe(2);
  expect(columnsOf(1120, 2)).toBe(2);
  expect(columnsOf(724, 9)).toBe(2);
  expect(columnsOf(200, 5)).toBe(1);
  expect(columnsOf(1120, 0)).toBe(1);
});
