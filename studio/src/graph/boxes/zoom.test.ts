import { expect, test } from "vitest";
import { FULL, lookAt, TITLE } from "./zoom";

test("the level of detail follows the zoom", () => {
  expect([0.05, TITLE - 0.01, TITLE, FULL - 0.01, FULL, 2].map((zoom) => lookAt(zoom).level)).toEqual([
    "dot",
    "dot",
    "title",
    "title",
    "full",
    "full",
  ]);
});

test("names keep their size on the screen, at least 11 px", () => {
  for (let zoom = 0.04; zoom < FULL; zoom *= 1.01) {
    const size = lookAt(zoom).text * zoom;
    expect(size).toBeGreaterThanOrEqual(11);
    expect(size).toBeLessThan(13);
  }
  expect(11 * FULL).toBeGreaterThanOrEqual(10);
});
