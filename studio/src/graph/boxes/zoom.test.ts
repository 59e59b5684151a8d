import { expect, test } from "vitest";
import { BOX, LIVE } from "../../architecture/boxes";
import { FULL, LINES, lookAt, NUMBERS, TITLE } from "./zoom";

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

test("a box has room for its name: for two lines where they are allowed, else for one", () => {
  const [tall, small] = [BOX.title + LIVE.curve + BOX.pad, BOX.title + LIVE.number + BOX.pad];
  // the height of a line, and the pad above it, in graph.css too
  const name = (zoom: number, lines: number) => 1.1 * lines * lookAt(zoom).text + 3;
  for (let zoom = TITLE; zoom < FULL; zoom *= 1.01) {
    const { numbers, lines } = lookAt(zoom);
    expect(name(zoom, lines ? 2 : 1), `a curve at ${zoom}`).toBeLessThan(tall);
    expect(name(zoom, numbers ? 2 : 1), `a number at ${zoom}`).toBeLessThan(small);
  }
  expect(LINES).toBeLessThan(NUMBERS);
});
