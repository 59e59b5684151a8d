// A layout that is much wider than the canvas, broken into lines, as text is: a long chain would otherwise be
// too small to read. One that is much higher is broken into columns.

import type { Point, Size } from "../model/rects";

const BETWEEN = 72;
const MOST_LINES = 12;
// Edges between lines run back around boxes, so lines have to make everything larger by this factor, and more
// lines than necessary by more than the second one.
const GAIN = 1.25;
const MORE = 1.1;
// Boxes are large enough at this zoom factor.
const LARGE = 0.82;

type PlacedBox = Point & Size & { id: string };

// As few lines or columns as make boxes large on a canvas of this size.
export function wrapped(
  places: Map<string, Point>,
  sizes: Map<string, Size>,
  panel: Size,
): Map<string, Point> {
  const all = [...places].map(([id, { x, y }]) => ({ id, x, y, ...(sizes.get(id) ?? NOTHING) }));
  if (all.length < 4) {
    return places;
  }
  const now = zoomOf(all, panel);
  const counts = Array.from({ length: Math.min(MOST_LINES, all.length) - 1 }, (_, i) => i + 2);
  const tried = counts
    .flatMap((count) => [inLines(all, count), turned(inLines(turned(all), count))])
    .map((boxes) => ({ boxes, zoom: zoomOf(boxes, panel) }));
  const top = Math.max(...tried.map(({ zoom }) => zoom));
  const found = top < GAIN * now ? undefined : tried.find(({ zoom }) => zoom * MORE >= top);
  return found === undefined ? places : new Map(found.boxes.map(({ id, x, y }) => [id, { x, y }]));
}

const NOTHING: Size = { width: 0, height: 0 };

function zoomOf(all: PlacedBox[], panel: Size): number {
  const width = Math.max(...all.map((a) => a.x + a.width)) - Math.min(...all.map((a) => a.x));
  const height = Math.max(...all.map((a) => a.y + a.height)) - Math.min(...all.map((a) => a.y));
  return Math.min(panel.width / width, panel.height / height, LARGE);
}

function inLines(all: PlacedBox[], count: number): PlacedBox[] {
  const left = Math.min(...all.map((a) => a.x));
  const width = Math.max(...all.map((a) => a.x + a.width)) - left;
  const lines = Array.from({ length: count }, () => [] as PlacedBox[]);
  for (const one of all) {
    const line = Math.floor(((one.x + one.width / 2 - left) / width) * count);
    lines[Math.min(line, count - 1)]?.push(one);
  }
  let top = 0;
  return lines
    .filter((line) => line.length > 0)
    .flatMap((line) => {
      const [x, y] = [Math.min(...line.map((a) => a.x)), Math.min(...line.map((a) => a.y))];
      const moved = line.map((a) => ({ ...a, x: a.x - x, y: a.y - y + top }));
      top += Math.max(...line.map((a) => a.y + a.height)) - y + BETWEEN;
      return moved;
    });
}

// Width and height exchanged, so that lines are columns.
function turned(all: PlacedBox[]): PlacedBox[] {
  return all.map(({ id, x, y, width, height }) => ({ id, x: y, y: x, width: height, height: width }));
}
