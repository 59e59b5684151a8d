// What lies at a cursor in a plot, in words.

import { cell } from "./axis";
import {
  type ColorMap,
  type Content,
  type CurveLine,
  marksOf,
  type Picture,
  rasterOf,
  type RowMap,
} from "./content";
import type { PlotSide, Tail } from "./content";
import { extent } from "./scale";
import { reading, timeText } from "./text";

// Positions on both sides; where the cursor is in another plot, one of them may be unknown.
export type At = Readonly<{ x: number | null; y: number | null }>;

const GAP = "   ";
const CHANNELS = 3;

export function readContent(content: Content, at: At): string {
  const raster = rasterOf(content);
  const [tail] = marksOf(content, "tail");
  const lines = marksOf(content, "line");
  const words =
    raster?.type === "map"
      ? readMap(content, raster, at)
      : raster?.type === "picture"
        ? readPicture(content, raster, at)
        : raster?.type === "rows"
          ? readRows(content, raster, at)
          : tail !== undefined
            ? readTail(content, tail, at)
            : readLines(content, lines, at);
  return words.join(GAP);
}

// A position on a side, with its name.
function position({ along, unit = "" }: PlotSide, value: number | null): string[] {
  if (along === null || value === null) {
    return [];
  }
  return [along === "time" ? `t ${timeText(value, unit)}` : `${along.name} ${reading(value)}`];
}

function readLines({ x }: Content, lines: readonly CurveLine[], at: At): string[] {
  const [first] = lines;
  if (at.x === null || first === undefined) {
    return [];
  }
  const samples = lines.map(({ xs }) => nearestIndex(xs, at.x as number));
  const [place] = samples.map((i, n) => lines[n]?.xs[i]);
  if (place === undefined) {
    return [];
  }
  const values = lines.flatMap(({ label, xs, ys }, n) => {
    const i = samples[n] as number;
    const value = xs[i] === place ? ys[i] : null;
    return value == null ? [] : [lines.length > 1 ? `${label} ${reading(value)}` : reading(value)];
  });
  return [...position(x, place), ...values];
}

// The number of the position that is nearest to a value, of positions in order; -1 if there is none.
export function nearestIndex(xs: ArrayLike<number>, value: number): number {
  let [low, high] = [0, xs.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if ((xs[middle] as number) <= value) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return high > low && (xs[high] as number) - value < value - (xs[low] as number)
    ? high
    : Math.min(low, high);
}

// Where the cursor of another plot has a position on one axis only, the maximum over the other axis.
function readMap({ x, y }: Content, { values, nx, ny }: ColorMap, at: At): string[] {
  const words = [...position(x, at.x), ...position(y, at.y)];
  const columns = cells(x, nx, at.x);
  const rows = cells(y, ny, at.y);
  let most = -Infinity;
  for (const i of columns) {
    for (const j of rows) {
      most = Math.max(most, values[i * ny + j] ?? -Infinity);
    }
  }
  if (!Number.isFinite(most)) {
    return words;
  }
  const folded = at.x === null || at.y === null ? "max " : "";
  return [...words, `${folded}${reading(most)}`];
}

function cells({ along }: PlotSide, count: number, at: number | null): number[] {
  return at === null || along === null || along === "time"
    ? Array.from({ length: count }, (_, i) => i)
    : [cell(along, count, at)];
}

// The colour at a position, its channels from 0 to 1.
function readPicture({ x, y }: Content, { values, nx, ny }: Picture, at: At): string[] {
  const words = [...position(x, at.x), ...position(y, at.y)];
  if (at.x === null || at.y === null) {
    return words;
  }
  const [i = 0] = cells(x, nx, at.x);
  const [j = 0] = cells(y, ny, at.y);
  const from = CHANNELS * (i * ny + j);
  const channels = [...values.subarray(from, from + CHANNELS)];
  return [...words, ...channels.map((value, c) => `${"rgb"[c]} ${reading(value)}`)];
}

// Where only the position is known, the value at the moment that is shown; where only the time is known, the
// maximum.
function readRows(content: Content, { rows }: RowMap, at: At): string[] {
  const across = content.x.along === "time";
  const [time, place] = across ? [at.x, at.y] : [at.y, at.x];
  const [timeSide, side] = across ? [content.x, content.y] : [content.y, content.x];
  const [moment] = marksOf(content, "moment");
  const values = rows.at(time ?? moment?.time ?? Infinity)?.values ?? [];
  const words = [...position(timeSide, time), ...position(side, place)];
  if (place === null) {
    const most = extent(values)?.[1];
    return most === undefined ? words : [...words, `max ${reading(most)}`];
  }
  const [sample = 0] = cells(side, rows.width, place);
  const value = values[sample];
  return value === undefined ? words : [...words, reading(value)];
}

function readTail({ x, y }: Content, tail: Tail, at: At): string[] {
  const i = at.x === null || at.y === null ? -1 : nearestPlace(tail, [at.x, at.y], [x, y]);
  const [time, across, up] = [tail.times[i], tail.xs[i], tail.ys[i]];
  return time === undefined || across === undefined || up === undefined
    ? []
    : [`t ${timeText(time, tail.unit)}`, reading(across), reading(up)];
}

// The number of the sample of a trajectory that is nearest to a position, both as shares of their sides; -1
// if there is none.
export function nearestPlace(
  { xs, ys }: Pick<Tail, "xs" | "ys">,
  [x, y]: readonly [number, number],
  sides: readonly [Pick<PlotSide, "range">, Pick<PlotSide, "range">],
): number {
  const [wide, high] = sides.map(({ range }) => range[1] - range[0]) as [number, number];
  return least(xs, (other, i) => Math.hypot((other - x) / wide, ((ys[i] as number) - y) / high));
}

// The number of the sample that is nearest to a time; -1 if there is none.
export function nearestTime({ times }: Pick<Tail, "times">, time: number): number {
  return least(times, (other) => Math.abs(other - time));
}

function least(values: readonly number[], distance: (value: number, i: number) => number): number {
  let [found, shortest] = [-1, Infinity];
  values.forEach((value, i) => {
    const now = distance(value, i);
    if (now < shortest) {
      [found, shortest] = [i, now];
    }
  });
  return found;
}
