// The course of an edge: a calm curve to the right, or around below the boxes where it has to go back.

import type { Point, Rect } from "./layout";

export type Course = { path: string; middle: Point };

const LANE = 28;
const BELOW = 20;
const BEND = 32;

// Whether an edge must go around: its target is not to the right.
export function goesBack(from: Point, to: Point): boolean {
  return to.x < from.x + 16;
}

// `lane` counts the edges that would run side by side: each takes its own course. `others` are boxes that an
// edge back keeps clear of.
export function course(
  from: Point,
  to: Point,
  source: Rect,
  target: Rect,
  lane: number,
  others: () => Rect[],
): Course {
  return goesBack(from, to)
    ? around(from, to, below(from, to, [source, target], others(), lane), lane)
    : ahead(from, to, lane);
}

function ahead(from: Point, to: Point, lane: number): Course {
  const reach = Math.max(28, (to.x - from.x) / 2);
  const bow = aside(lane) * LANE * (4 / 3);
  const [a, b] = [
    { x: from.x + reach, y: from.y + bow },
    { x: to.x - reach, y: to.y + bow },
  ];
  const middle = { x: (from.x + 3 * a.x + 3 * b.x + to.x) / 8, y: (from.y + 3 * a.y + 3 * b.y + to.y) / 8 };
  return { path: `M${from.x},${from.y} C${a.x},${a.y} ${b.x},${b.y} ${to.x},${to.y}`, middle };
}

function around(from: Point, to: Point, y: number, lane: number): Course {
  const [right, left] = [from.x + BEND + lane * 8, to.x - BEND - lane * 8];
  const path =
    `M${from.x},${from.y} C${right},${from.y} ${right},${y} ${from.x},${y} ` +
    `L${to.x},${y} C${left},${y} ${left},${to.y} ${to.x},${to.y}`;
  return { path, middle: { x: (from.x + to.x) / 2, y } };
}

// A height below both ends without obstacles.
function below(from: Point, to: Point, ends: Rect[], others: Rect[], lane: number): number {
  let y = Math.max(...ends.map((end) => end.y + end.height)) + BELOW;
  const near = others
    .filter((rect) => rect.x < from.x && rect.x + rect.width > to.x)
    .sort((a, b) => a.y - b.y);
  for (const rect of near) {
    if (rect.y - BELOW / 2 < y && rect.y + rect.height + BELOW > y) {
      y = rect.y + rect.height + BELOW;
    }
  }
  return y + lane * LANE;
}

// 0, 1, -1, 2, -2, ...
function aside(lane: number): number {
  return lane % 2 === 1 ? (lane + 1) / 2 : -lane / 2;
}
