import { expect, test } from "vitest";
import { course } from "./wirePath";

const box = (x: number, y: number) => ({ x, y, width: 100, height: 50 });

test("a forward edge has its middle between its ends, and lanes have a distance", () => {
  const at = (lane: number) =>
    course({ x: 100, y: 25 }, { x: 300, y: 25 }, box(0, 0), box(300, 0), lane, () => []).middle;
  expect(at(0)).toEqual({ x: 200, y: 25 });
  expect(at(1).y).toBeGreaterThan(45);
  expect(at(2).y).toBeLessThan(5);
});

test("a backward edge runs below both ends and the boxes between them", () => {
  const others = [box(150, 40), box(150, 400), box(900, 60)];
  const { middle } = course({ x: 400, y: 25 }, { x: 0, y: 25 }, box(300, 0), box(0, 0), 0, () => others);
  expect(middle.x).toBe(200);
  expect(middle.y).toBeGreaterThan(90);
  expect(middle.y).toBeLessThan(150);
});
