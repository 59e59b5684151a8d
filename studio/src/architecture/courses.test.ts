import { expect, test } from "vitest";

import { courses } from "./courses";
import type { Point, Rect } from "../model/rects";
import type { WireLine } from "./turns";
import type { Course } from "./wirePath";

const SIZE = { width: 100, height: 50 };
const box = (x: number, y: number): Rect => ({ x, y, ...SIZE });

/** A wire from the right side of a box to the left side of another one. */
const wire = (id: string, from: Rect, to: Rect, net = id): WireLine => ({
  id,
  net,
  from: { x: from.x + SIZE.width + 4, y: from.y + 25 },
  to: { x: to.x - 4, y: to.y + 25 },
});

const led = (wires: WireLine[], boxes: Rect[], rooms = new Map<string, number>()): Course[] => [
  ...courses(wires, boxes, rooms).values(),
];

/** Points on a path of lines and cubic curves. */
function points({ path }: Course): Point[] {
  const found: Point[] = [];
  for (const [, kind, rest = ""] of path.matchAll(/([MLC])([^MLC]*)/g)) {
    const numbers = rest.trim().split(/[ ,]+/).map(Number);
    const at = Array.from({ length: numbers.length / 2 }, (_, i) => ({
      x: numbers[2 * i] ?? Number.NaN,
      y: numbers[2 * i + 1] ?? Number.NaN,
    }));
    const begin = found.at(-1) ?? (at[0] as Point);
    const [a, b, end] = kind === "C" ? at : [begin, at[0], at[0]];
    for (let i = 1; i <= 40; i++) {
      const [t, u] = [i / 40, 1 - i / 40];
      const mix = (axis: "x" | "y") =>
        u ** 3 * begin[axis] +
        3 * u * u * t * (a as Point)[axis] +
        3 * u * t * t * (b as Point)[axis] +
        t ** 3 * (end as Point)[axis];
      found.push({ x: mix("x"), y: mix("y") });
    }
  }
  return found;
}

const inside = ({ x, y }: Point, rect: Rect): boolean =>
  x > rect.x && x < rect.x + rect.width && y > rect.y && y < rect.y + rect.height;

function heightAt(course: Course, x: number): number {
  const all = points(course);
  return all.reduce((best, one) => (Math.abs(one.x - x) < Math.abs(best.x - x) ? one : best)).y;
}

test("a wire between boxes at one height is straight", () => {
  const [from, to] = [box(0, 0), box(400, 0)];
  const [course] = led([wire("a", from, to)], [from, to]);
  expect(points(course as Course).filter(({ y }) => Math.abs(y - 25) > 0.01)).toEqual([]);
  expect(course?.middle).toEqual({ x: 250, y: 25 });
});

test("a wire passes the box in its way on the nearer side", () => {
  const [from, to] = [box(0, 0), box(600, 0)];
  const [above] = led([wire("a", from, to)], [from, to, box(300, 0), box(300, 60)]);
  expect(heightAt(above as Course, 350)).toBeLessThan(0);
  const [below] = led([wire("a", from, to)], [from, to, box(300, 0), box(300, -60)]);
  expect(heightAt(below as Course, 350)).toBeGreaterThan(50);
});

test("a wire back runs below its boxes and those between them", () => {
  const [to, from] = [box(0, 0), box(400, 0)];
  const [course] = led([wire("a", from, to)], [from, to, box(200, 10)]);
  expect(heightAt(course as Course, 250)).toBeGreaterThan(60);
  expect(heightAt(course as Course, 250)).toBeLessThan(120);
  const [loop] = led([wire("a", to, to)], [to]);
  expect(heightAt(loop as Course, 50)).toBeGreaterThan(50);
});

test("wires between the same boxes run side by side", () => {
  const [from, to] = [box(0, 0), box(600, 0)];
  const several = led([wire("a", from, to), wire("b", from, to), wire("c", from, to)], [from, to]);
  const heights = several.map((course) => heightAt(course, 350)).sort((a, b) => a - b);
  expect((heights[1] ?? 0) - (heights[0] ?? 0)).toBeGreaterThan(3);
  expect((heights[2] ?? 0) - (heights[1] ?? 0)).toBeGreaterThan(3);
});

test("wires of one port run together until they part", () => {
  const [from, near, far] = [box(0, 0), box(400, 300), box(800, 300)];
  const [one, other] = led([wire("a", from, near, "n"), wire("b", from, far, "n")], [from, near, far]);
  expect(heightAt(one as Course, 130)).toBe(heightAt(other as Course, 130));
});

test("no wire runs behind a box of a hundred, forward or back, and labels cover none", () => {
  // a generator of equal numbers in each run
  let seed = 7;
  const draw = (most: number) => {
    seed = (seed * 16807) % 2147483647;
    return seed % most;
  };
  const boxes = Array.from({ length: 100 }, (_, i) =>
    box(180 * (i % 10) + draw(20), 100 * Math.floor(i / 10) + draw(30)),
  );
  const wires = Array.from({ length: 150 }, (_, i) =>
    wire(`w${i}`, boxes[draw(100)] as Rect, boxes[draw(100)] as Rect),
  );
  const found = courses(wires, boxes, new Map(wires.slice(0, 40).map(({ id }) => [id, 24])));
  expect(found.size).toBe(150);
  const behind = [...found].filter(([, course]) =>
    points(course).some((point) => boxes.some((one) => inside(point, one))),
  );
  expect(behind.map(([id]) => id)).toEqual([]);
  const middles = wires.slice(0, 40).map(({ id }) => (found.get(id) as Course).middle);
  expect(middles.filter((point) => boxes.some((one) => inside(point, one)))).toEqual([]);
});

test("a wire whose way is closed has no course", () => {
  const [from, to] = [box(0, 0), box(600, 0)];
  expect(led([wire("a", from, to)], [from, to, { x: 50, y: -300, width: 900, height: 700 }])).toEqual([]);
});
