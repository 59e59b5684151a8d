import { expect, test } from "vitest";

import { marksOf } from "../draw/content";
import { readContent } from "../draw/cursorText";
import { curveContent } from "./curve";

const CURVE = { input: [0, 1, 2], up: [-5, -4, 6], down: [-5, 4, 6], threshold: 0 };

test("both branches are lines on one scale, which the threshold is part of", () => {
  const content = curveContent(CURVE);
  expect([content.x.range, content.y.range]).toEqual([
    [0, 2],
    [-5, 6],
  ]);
  expect(curveContent({ ...CURVE, threshold: 20 }).y.range[1]).toBe(20);
  expect(readContent(content, { x: 1.1, y: 0 })).toBe("input falls 4.000   input grows \u22124.000");
});

test("a value that is missing leaves a gap", () => {
  const [, grows] = marksOf(curveContent({ ...CURVE, up: [-5, null, 6] }), "line");
  expect(grows?.ys).toEqual([-5, Number.NaN, 6]);
});

test("a field that never changes has ranges to draw in", () => {
  const { x, y } = curveContent({ input: [0, 0], up: [0, 0], down: [0, 0], threshold: 0 });
  for (const [lower, upper] of [x.range, y.range]) expect(upper).toBeGreaterThan(lower);
});
