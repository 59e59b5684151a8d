// Ranges of values on an axis or a colour scale, and round places inside them.

export type Range = readonly [lower: number, upper: number];

const SHRINK_AFTER_MS = 3000;
const SHRINK_BELOW = 0.6;

// The least range with round bounds around some values.
export function round([lower, upper]: Range): Range {
  const span = upper - lower || Math.abs(upper) || 1;
  const size = 10 ** Math.floor(Math.log10(span));
  const step = span / size < 2 ? size / 10 : span / size < 5 ? size / 5 : size / 2;
  const [low, high] = upper > lower ? [lower, upper] : [lower - span / 2, upper + span / 2];
  return [clean(Math.floor(low / step + 1e-9) * step), clean(Math.ceil(high / step - 1e-9) * step)];
}

export function union(one: Range, other: Range): Range {
  return [Math.min(one[0], other[0]), Math.max(one[1], other[1])];
}

// A range that follows values calmly: it grows at once, and shrinks only after all values of some seconds
// would fit into a much smaller one.
export class CalmRange {
  private shown: Range | null = null;
  private needed: Range | null = null;
  private since = 0;

  // `room`: how much of the range stays free on both sides.
  constructor(private room = 0) {}

  // The range for values in `extent` (null: none) and for levels that have to be seen, at a moment of the
  // wall clock in ms.
  next(extent: Range | null, include: number[], now: number): Range {
    let target = extent;
    for (const level of include) {
      target = target === null ? [level, level] : union(target, [level, level]);
    }
    if (target === null) {
      return this.shown ?? [0, 1];
    }
    const free = this.room * (target[1] - target[0]);
    target = round([target[0] - free, target[1] + free]);
    if (this.shown === null || target[0] < this.shown[0] || target[1] > this.shown[1]) {
      this.shown = this.shown === null ? target : union(target, this.shown);
      this.needed = null;
    } else {
      this.shrink(target, this.shown, now);
    }
    return this.shown;
  }

  clear(): void {
    this.shown = null;
    this.needed = null;
  }

  private shrink(target: Range, shown: Range, now: number): void {
    const needed: Range = this.needed === null ? target : union(this.needed, target);
    if (needed[1] - needed[0] > SHRINK_BELOW * (shown[1] - shown[0])) {
      this.needed = null;
      return;
    }
    if (this.needed === null) {
      this.since = now;
    }
    this.needed = needed;
    if (now - this.since > SHRINK_AFTER_MS) {
      this.shown = needed;
      this.needed = null;
    }
  }
}

// About `count` round places inside a range.
export function ticks([lower, upper]: Range, count: number): { places: number[]; step: number } {
  const rough = (upper - lower) / Math.max(1, count);
  if (!(rough > 0)) {
    return { places: [lower], step: 1 };
  }
  const size = 10 ** Math.floor(Math.log10(rough));
  const step = size * ([1, 2, 5, 10].find((n) => n * size >= rough * (1 - 1e-9)) ?? 10);
  const places: number[] = [];
  for (let i = Math.ceil(lower / step - 1e-9); i * step <= upper + 1e-9 * step; i++) {
    places.push(clean(i * step));
  }
  return { places, step };
}

function clean(value: number): number {
  return Number(value.toPrecision(12)) + 0;
}

// The least and the greatest value that is finite; null if there is none.
export function extent(values: ArrayLike<number>): Range | null {
  let lower = Infinity;
  let upper = -Infinity;
  for (let i = 0; i < values.length; i++) {
    const value = values[i] as number;
    if (value < lower && value > -Infinity) {
      lower = value;
    }
    if (value > upper && value < Infinity) {
      upper = value;
    }
  }
  return lower <= upper ? [lower, upper] : null;
}
