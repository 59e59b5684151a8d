// A layout that is much wider than high, broken into lines, as text is: a long chain would otherwise be too
// small to read.

import type { Point, Size } from "./layout";

const WIDEST = 6.5;
// What lines together aim at: the shape of the canvas.
const SHAPE = 2.2;
const BETWEEN_LINES = 72;

export function wrapped(places: Map<string, Point>, sizes: Map<string, Size>): Map<string, Point> {
  const all = [...places].map(([id, { x, y }]) => {
    const { width, height } = sizes.get(id) ?? { width: 0, height: 0 };
    return { id, x, y, width, height };
  });
  const left = Math.min(...all.map((a) => a.x));
  const width = Math.max(...all.map((a) => a.x + a.width)) - left;
  const height = Math.max(...all.map((a) => a.y + a.height)) - Math.min(...all.map((a) => a.y));
  if (all.length < 4 || width / height <= WIDEST) {
    return places;
  }
  const count = Math.max(2, Math.round(Math.sqrt(width / (height + BETWEEN_LINES) / SHAPE)));
  const lines = Array.from({ length: count }, () => [] as typeof all);
  for (const one of all) {
    const line = Math.floor(((one.x + one.width / 2 - left) / width) * count);
    lines[Math.min(line, count - 1)]?.push(one);
  }
  const out = new Map<string, Point>();
  let top = 0;
  for (const line of lines.filter((l) => l.length > 0)) {
    const [x, y] = [Math.min(...line.map((a) => a.x)), Math.min(...line.map((a) => a.y))];
    line.forEach((a) => out.set(a.id, { x: a.x - x, y: a.y - y + top }));
    top += Math.max(...line.map((a) => a.y + a.height)) - y + BETWEEN_LINES;
  }
  return out;
}
