// The grid on which wires are led past boxes: columns between the sides of boxes, and horizontal tracks. It
// counts the wires in each cell, so that the next one crosses few of them.

import type { Point, Rect } from "../model/rects";

// The distance of tracks, and so of wires side by side.
const TRACK = 6;
// What a wire keeps clear of boxes above and below it.
const CLEAR = 5;
// Beside a box, a wire better runs straight.
const MARGIN = 10;
// A column that could be narrower than this belongs to the one beside it.
const THIN = 1;
// Columns left and right of all boxes, and tracks above and below them.
const ROOM = 72;
// The tracks above and below both ends that are tried before all others.
const WINDOW = 50;
// In px of length. `overlap`: the factor of a length on another wire; `beside`: that of a length up or down
// beside a box; `above`: a wire back better runs below the boxes, away from their names.
const COST = { bend: 80, crossing: 30, overlap: 0.5, beside: 3, above: 200 };

// The tracks on which a wire enters and leaves each of its columns, in its direction.
export type Route = { columns: number[]; enters: number[]; leaves: number[] };

// Between which columns and tracks a wire runs: it may turn round as far out as `outermost` and `innermost`.
type RouteSpan = {
  back: boolean;
  begin: number;
  end: number;
  first: number;
  last: number;
  outermost: number;
  innermost: number;
};

export class Tracks {
  private readonly sides: number[];
  private readonly top: number;
  private readonly count: number;
  private readonly solid: Uint8Array;
  private readonly beside: Uint8Array;
  // The numbers of wires that run straight through a cell, and that go up or down across it.
  private readonly straight: Float32Array;
  private readonly across: Float32Array;

  // `ends` are the points at which wires begin and end.
  constructor(boxes: Rect[], ends: Point[]) {
    const ys = [...boxes.flatMap(({ y, height }) => [y, y + height]), ...ends.map(({ y }) => y)];
    const sides = boxes
      .flatMap(({ x, width }) => [x - MARGIN, x, x + width, x + width + MARGIN])
      .sort((a, b) => a - b);
    this.sides = thinned([(sides[0] ?? 0) - ROOM, ...sides, (sides.at(-1) ?? 0) + ROOM]);
    const [highest, lowest] = ys.reduce(
      ([least, most], y) => [Math.min(least, y), Math.max(most, y)],
      [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY],
    );
    this.top = highest - ROOM;
    this.count = Math.ceil((lowest + ROOM - this.top) / TRACK) + 1;
    const cells = this.columns * this.count;
    this.solid = new Uint8Array(cells);
    this.beside = new Uint8Array(cells);
    this.straight = new Float32Array(cells);
    this.across = new Float32Array(cells);
    for (const box of boxes) {
      this.fill(this.beside, { ...box, x: box.x - MARGIN, width: box.width + 2 * MARGIN });
      this.fill(this.solid, box);
    }
  }

  get columns(): number {
    return this.sides.length - 1;
  }

  columnAt(x: number): number {
    let [low, high] = [0, this.columns - 1];
    while (low < high) {
      const middle = Math.ceil((low + high) / 2);
      if (this.left(middle) <= x) {
        low = middle;
      } else {
        high = middle - 1;
      }
    }
    return low;
  }

  left(column: number): number {
    return this.sides[column] ?? 0;
  }

  right(column: number): number {
    return this.left(column + 1);
  }

  trackAt(y: number): number {
    return Math.max(0, Math.min(this.count - 1, Math.round((y - this.top) / TRACK)));
  }

  height(track: number): number {
    return this.top + track * TRACK;
  }

  // What of a stretch around a column has no box between two tracks.
  free(column: number, tracks: [number, number], from: number, to: number): { from: number; to: number } {
    let [first, last] = [column, column];
    while (first > 0 && this.left(first) > from && this.isFree(first - 1, tracks)) {
      first -= 1;
    }
    while (last + 1 < this.columns && this.right(last) < to && this.isFree(last + 1, tracks)) {
      last += 1;
    }
    return { from: Math.max(from, this.left(first)), to: Math.min(to, this.right(last)) };
  }

  // Counts a wire in the cells of its route, or no longer (-1).
  add({ columns, enters, leaves }: Route, sign: 1 | -1): void {
    columns.forEach((column, i) => {
      const base = column * this.count;
      const [enter, leave] = [enters[i] ?? 0, leaves[i] ?? 0];
      const [low, high] = [Math.min(enter, leave), Math.max(enter, leave)];
      for (const track of [low, high]) {
        this.straight[base + track] = (this.straight[base + track] ?? 0) + sign / 2;
      }
      for (let track = low + 1; track < high; track++) {
        this.across[base + track] = (this.across[base + track] ?? 0) + sign;
      }
    });
  }

  // The cheapest route between two points that passes no box; null if there is none. It runs in one
  // direction, but a wire back may go away from its box before it turns round.
  route(from: Point, to: Point, back: boolean): Route | null {
    const [begin, end] = [this.trackAt(from.y), this.trackAt(to.y)];
    const [first, last] = [this.columnAt(from.x + 1), this.columnAt(to.x - 1)];
    const span: RouteSpan = {
      back,
      begin,
      end,
      first,
      last,
      outermost: back ? this.away(first, begin, 1) : first,
      innermost: back ? this.away(last, end, -1) : last,
    };
    const [low, high] = [Math.max(0, Math.min(begin, end) - WINDOW), Math.max(begin, end) + WINDOW + 1];
    return this.routeWithin(span, low, Math.min(high, this.count)) ?? this.routeWithin(span, 0, this.count);
  }

  // The farthest column that a track reaches from this one without a box.
  private away(column: number, track: number, step: 1 | -1): number {
    const limit = this.left(column) + step * ROOM;
    let found = column;
    for (let next = column + step; next >= 0 && next < this.columns; next += step) {
      if (this.solid[next * this.count + track] === 1 || (this.left(next) - limit) * step > 0) {
        break;
      }
      found = next;
    }
    return found;
  }

  // Column by column, the least cost of each track.
  private routeWithin(span: RouteSpan, low: number, high: number): Route | null {
    const { back, first, last, outermost, innermost } = span;
    const tracks = high - low;
    const step = back ? -1 : 1;
    const columns = (innermost - outermost) * step + 1;
    const [begin, end] = [span.begin - low, span.end - low];
    const enters = new Int32Array(columns * tracks);
    let costs = new Float64Array(tracks).fill(Number.POSITIVE_INFINITY);
    let next = new Float64Array(tracks);
    let best = { cost: Number.POSITIVE_INFINITY, columns: 0 };
    for (let i = 0; i < columns; i++) {
      const column = outermost + i * step;
      const [before, after] = [(first - column) * step, (column - last) * step];
      if (before >= 0) {
        costs[begin] = before === 0 ? 0 : 2 * (this.left(column) - this.left(first));
      }
      const entry = enters.subarray(i * tracks, (i + 1) * tracks);
      this.leave(column, low, { costs, next, entry, isEnd: before >= 0 || after >= 0 });
      [costs, next] = [next, costs];
      if (back && before === 0) {
        for (let track = 0; track < begin; track++) {
          costs[track] = (costs[track] ?? 0) + COST.above;
        }
      }
      const cost = (costs[end] ?? 0) + 2 * Math.max(0, this.left(last) - this.left(column));
      if (after >= 0 && cost < best.cost) {
        best = { cost, columns: i + 1 };
      }
    }
    return best.columns === 0 ? null : traced(enters.subarray(0, best.columns * tracks), tracks, low, span);
  }

  // The costs of leaving a column (`next`) from those of entering it, and the best track of entry for each.
  // Wires with one end run together near it, so that an overlap there costs nothing.
  private leave(
    column: number,
    low: number,
    {
      costs,
      next,
      entry,
      isEnd,
    }: { costs: Float64Array; next: Float64Array; entry: Int32Array; isEnd: boolean },
  ): void {
    const base = column * this.count + low;
    const tracks = costs.length;
    const length = this.right(column) - this.left(column);
    for (let track = 0; track < tracks; track++) {
      const overlap = isEnd ? 0 : length * Math.min(2, this.straight[base + track] ?? 0);
      next[track] =
        this.solid[base + track] === 1
          ? Number.POSITIVE_INFINITY
          : (costs[track] ?? 0) + COST.overlap * overlap + COST.crossing * (this.across[base + track] ?? 0);
      entry[track] = track;
    }
    for (const step of [1, -1]) {
      let [best, from] = [Number.POSITIVE_INFINITY, 0];
      for (let track = step > 0 ? 0 : tracks - 1; track >= 0 && track < tracks; track += step) {
        const cell = base + track;
        if (this.solid[cell] === 1) {
          best = Number.POSITIVE_INFINITY;
          continue;
        }
        best += TRACK * (this.beside[cell] === 1 ? COST.beside : 1);
        if (best + COST.bend < (next[track] ?? 0)) {
          next[track] = best + COST.bend;
          entry[track] = from;
        }
        best += COST.crossing * (this.straight[cell] ?? 0);
        if ((costs[track] ?? 0) < best) {
          best = costs[track] ?? 0;
          from = track;
        }
      }
    }
  }

  private isFree(column: number, [low, high]: [number, number]): boolean {
    const base = column * this.count;
    return !this.solid.subarray(base + low, base + high + 1).includes(1);
  }

  private fill(mask: Uint8Array, { x, y, width, height }: Rect): void {
    const high = this.trackAt(y - CLEAR + TRACK / 2);
    const low = this.trackAt(y + height + CLEAR - TRACK / 2);
    for (let column = this.columnAt(x + THIN); this.left(column) < x + width - THIN; column++) {
      mask.fill(1, column * this.count + high, column * this.count + low + 1);
    }
  }
}

// The route of the tracks of entry of its columns.
function traced(enters: Int32Array, tracks: number, low: number, span: RouteSpan): Route {
  const { back, begin, end, first, outermost } = span;
  const route: Route = { columns: [], enters: [], leaves: [] };
  let track = end - low;
  for (let i = enters.length / tracks - 1; i >= 0; i--) {
    const column = outermost + i * (back ? -1 : 1);
    const enter = enters[i * tracks + track] ?? 0;
    if (back && column > first && track + low === begin) {
      break;
    }
    route.columns.unshift(column);
    route.leaves.unshift(track + low);
    route.enters.unshift(enter + low);
    track = enter;
  }
  return route;
}

function thinned(sorted: number[]): number[] {
  const found: number[] = [];
  for (const x of sorted) {
    if (found.length === 0 || x - (found.at(-1) ?? 0) >= THIN) {
      found.push(x);
    }
  }
  return found;
}
