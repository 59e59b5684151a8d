// The grid of a large architecture: names are split at `_` into prefix and suffix. A prefix has a row, a
// suffix a column, and the columns of one digit at the end of the suffix form a frame.

import type { Point, Size } from "../model/rects";

// A wire between two boxes.
export type GridWire = { source: string; target: string };
// `fed`: whether the box receives stimuli.
export type GridBox = { id: string; name: string; fed: boolean };

// Fewer boxes, or fewer names that share both parts with others, form no grid.
const LEAST = { boxes: 12, shared: 0.5 };
// Rows and columns with at most this number of boxes share their place with others.
const SPARSE = 2;
// Gaps between boxes have room for wires; a frame stands apart. They grow with the canvas up to `most`.
const GAP = { x: 48, y: 40, frame: 44, most: 160 };
// In px. `up`: a wire better leads down; `fed`: of a row that receives stimuli, for each row above it.
const COST = { up: 60, fed: 5000 };

type NameParts = { prefix: string; suffix: string };

export function partsOf(name: string): NameParts {
  const at = name.indexOf("_");
  return at < 0 || at === name.length - 1
    ? { prefix: name, suffix: "" }
    : { prefix: name.slice(0, at), suffix: name.slice(at + 1) };
}

export const digitOf = (suffix: string): string => /\d+$/.exec(suffix)?.[0] ?? "";

// Whether names form a grid.
export function isGrid(names: string[]): boolean {
  const parts = names.map(partsOf).filter(({ suffix }) => suffix !== "");
  const isShared = (one: NameParts) =>
    parts.some((other) => other !== one && other.prefix === one.prefix) &&
    parts.some((other) => other !== one && other.suffix === one.suffix);
  return names.length >= LEAST.boxes && parts.filter(isShared).length >= LEAST.shared * names.length;
}

type GridCell = { id: string; row: number; column: number };
// Columns of a frame in their order.
type Order = { rows: number[]; frames: number[][] };

// The positions of boxes of one size on a canvas of this shape.
export function gridPlaces(boxes: GridBox[], wires: GridWire[], size: Size, panel: Size): Map<string, Point> {
  const { cells, rows, columns, fed } = cellsOf(boxes);
  const frames = framesOf(columns);
  const order = shortest(cells, wires, fed, { rows: [...rows.keys()], frames });
  const gaps = gapsFor(size, panel, order);
  const [x, y] = [columnsAt(order.frames, size.width, gaps), rowsAt(order.rows, size.height, gaps.y)];
  return new Map(
    cells.map(({ id, row, column }) => [id, { x: x.get(column) ?? 0, y: y.get(row) ?? 0 }] as const),
  );
}

// The columns of each digit.
function framesOf(columns: string[][]): number[][] {
  const digits = columns.map(([suffix]) => digitOf(suffix ?? ""));
  return [...new Set(digits)].map((digit) =>
    digits.flatMap((other, column) => (other === digit ? [column] : [])),
  );
}

// Sparse rows and columns share their places. Rows that receive stimuli stay alone, or the stimuli would
// enter in the middle.
function cellsOf(boxes: GridBox[]) {
  const named = boxes.map(({ id, name, fed }) => ({ id, fed, ...partsOf(name) }));
  const fedPrefixes = new Set(named.filter(({ fed }) => fed).map(({ prefix }) => prefix));
  const rows = packed(
    named.map(({ prefix, suffix }) => [prefix, suffix]),
    (one, other) => !fedPrefixes.has(one) && !fedPrefixes.has(other),
    SPARSE,
  );
  const rowOf = (prefix: string) => rows.findIndex((row) => row.includes(prefix));
  const columns = packed(
    named.map(({ prefix, suffix }) => [suffix, String(rowOf(prefix))]),
    (one, other) => digitOf(one) === digitOf(other),
    rows.length,
  );
  const cells: GridCell[] = named.map(({ id, prefix, suffix }) => ({
    id,
    row: rowOf(prefix),
    column: columns.findIndex((column) => column.includes(suffix)),
  }));
  const fed = new Set(rows.flatMap((row, n) => (row.some((prefix) => fedPrefixes.has(prefix)) ? [n] : [])));
  return { cells, rows, columns, fed };
}

// Lines of keys: the shortest one joins another one of at most `most` places, where none of these is taken
// twice.
function packed(
  pairs: [string, string][],
  mayJoin: (one: string, other: string) => boolean,
  most: number,
): string[][] {
  let lines: GridLine[] = [...new Set(pairs.map(([key]) => key))].map((key) => ({
    keys: [key],
    places: new Set(pairs.flatMap(([other, place]) => (other === key ? [place] : []))),
  }));
  for (;;) {
    lines.sort((a, b) => a.places.size - b.places.size);
    const pair = joinable(lines, mayJoin, most);
    if (pair === null) {
      return lines.map(({ keys }) => keys);
    }
    const [one, other] = pair;
    const joined = {
      keys: [...other.keys, ...one.keys],
      places: new Set([...other.places, ...one.places]),
    };
    lines = [...lines.filter((line) => line !== one && line !== other), joined];
  }
}

type GridLine = { keys: string[]; places: Set<string> };

function joinable(
  lines: GridLine[],
  mayJoin: (one: string, other: string) => boolean,
  most: number,
): [GridLine, GridLine] | null {
  for (const one of lines) {
    const other = lines.find(
      (line) =>
        line !== one &&
        one.places.size <= SPARSE &&
        line.places.size <= most &&
        mayJoin(one.keys[0] ?? "", line.keys[0] ?? "") &&
        ![...one.places].some((place) => line.places.has(place)),
    );
    if (other !== undefined) {
      return [one, other];
    }
  }
  return null;
}

type Gaps = { x: number; y: number; frame: number };
const LEAST_GAPS: Gaps = { x: GAP.x, y: GAP.y, frame: GAP.frame };
// Any size: only the order is sought.
const NOMINAL: Size = { width: 156, height: 104 };
// Lengths of wires and places of lines that a search computes at most: about 50 ms.
const MOST_COMPUTED = 1e6;

// The order with the shortest wires: rows, frames and columns move one by one while this shortens them, and
// not too much was computed.
function shortest(cells: GridCell[], wires: GridWire[], fed: Set<number>, start: Order): Order {
  const at = new Map(cells.map((cell) => [cell.id, cell]));
  const joined = wires.flatMap(({ source, target }) => {
    const [from, to] = [at.get(source), at.get(target)];
    return from === undefined || to === undefined || from === to ? [] : [{ from, to }];
  });
  const cost = (order: Order): number => {
    const x = columnsAt(order.frames, NOMINAL.width, LEAST_GAPS);
    const y = rowsAt(order.rows, NOMINAL.height, GAP.y);
    const length = joined.reduce((sum, { from, to }) => {
      const across = Math.abs((x.get(to.column) ?? 0) - (x.get(from.column) ?? 0));
      const down = (y.get(to.row) ?? 0) - (y.get(from.row) ?? 0);
      return sum + across + Math.abs(down) + (down < 0 ? COST.up : 0);
    }, 0);
    return order.rows.reduce((sum, row, n) => sum + (fed.has(row) ? COST.fed * n : 0), length);
  };
  const step = joined.length + start.rows.length + start.frames.flat().length;
  let best = { order: start, cost: cost(start) };
  let computed = step;
  for (let before = Infinity; best.cost < before;) {
    before = best.cost;
    for (const order of moves(best.order)) {
      computed += step;
      if (computed > MOST_COMPUTED) {
        return best.order;
      }
      const own = cost(order);
      if (own < best.cost) {
        best = { order, cost: own };
      }
    }
  }
  return best.order;
}

// All orders in which one row, frame or column stands elsewhere.
function* moves({ rows, frames }: Order): Generator<Order> {
  for (const other of moved(rows)) {
    yield { rows: other, frames };
  }
  for (const other of moved(frames)) {
    yield { rows, frames: other };
  }
  for (const [n, columns] of frames.entries()) {
    for (const other of moved(columns)) {
      yield { rows, frames: frames.with(n, other) };
    }
  }
}

function* moved<T>(items: T[]): Generator<T[]> {
  for (const [from, item] of items.entries()) {
    const rest = items.toSpliced(from, 1);
    for (let to = 0; to < items.length; to++) {
      if (to !== from) {
        yield rest.toSpliced(to, 0, item);
      }
    }
  }
}

function columnsAt(frames: number[][], width: number, { x: gap, frame }: Gaps): Map<number, number> {
  const at = new Map<number, number>();
  let x = 0;
  for (const columns of frames) {
    for (const column of columns) {
      at.set(column, x);
      x += width + gap;
    }
    x += frame;
  }
  return at;
}

function rowsAt(rows: number[], height: number, gap: number): Map<number, number> {
  return new Map(rows.map((row, n) => [row, n * (height + gap)] as const));
}

// The grid takes the shape of the canvas, as far as gaps may grow.
function gapsFor(size: Size, panel: Size, { rows, frames }: Order): Gaps {
  const columns = frames.flat().length;
  const [across, down] = [columns - 1, rows.length - 1];
  const apart = GAP.frame * (frames.length - 1);
  const width = columns * size.width + across * GAP.x + apart;
  const height = rows.length * size.height + down * GAP.y;
  const grown = (least: number, missing: number, gaps: number) =>
    gaps <= 0 || missing <= 0 ? least : Math.min(GAP.most, least + Math.floor(missing / gaps));
  return {
    x: grown(GAP.x, (height * panel.width) / panel.height - width, across),
    y: grown(GAP.y, (width * panel.height) / panel.width - height, down),
    frame: GAP.frame,
  };
}
