import { expect, test } from "vitest";

import { curvePaths, SIZE } from "./curve";

const CURVE = { input: [0, 1, 2], up: [-5, -4, 6], down: [-5, 4, 6], threshold: 0 };

const points = (path: string) =>
  path
    .split(/[ML]/)
    .slice(1)
    .map((point) => point.split(" ").map(Number));

test("both branches begin and end together and part between", () => {
  const { up, down, threshold } = curvePaths(CURVE);
  const [a, b] = [points(up), points(down)];
  expect(a).toHaveLength(3);
  expect(a[0]).toEqual(b[0]);
  expect(a[2]).toEqual(b[2]);
  const [rest, peak] = [a[1]?.[1] ?? 0, b[1]?.[1] ?? 0];
  // the axis of a picture points down
  expect(rest).toBeGreaterThan(threshold);
  expect(peak).toBeLessThan(threshold);
  for (const [x = -1, y = -1] of [...a, ...b]) {
    expect(x).toBeGreaterThan(0);
    expect(x).toBeLessThan(SIZE.width);
    expect(y).toBeGreaterThan(0);
    expect(y).toBeLessThan(SIZE.height);
  }
});

test("a value that is missing leaves a gap", () => {
  expect(curvePaths({ ...CURVE, up: [-5, null, 6] }).up).toMatch(/^M[\d. ]+M[\d. ]+$/);
});

test("a field that never changes has paths with numbers", () => {
  const { up, x, y } = curvePaths({ input: [0, 0], up: [0, 0], down: [0, 0], threshold: 0 });
  expect(`${up} ${JSON.stringify([x, y])}`).not.toMatch(/NaN|null/);
});
