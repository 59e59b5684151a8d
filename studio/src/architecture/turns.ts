// The turns of wires: where each goes from one height to another, side by side with those of other wires.

import type { Point } from "../model/rects";
import type { Route, Tracks } from "./tracks";

// A wire on the canvas. Wires of the same `net`, which begin at the same port, may run on one another.
export type WireLine = { id: string; net: string; from: Point; to: Point };

// From a height to another one, between two positions; around an end it bulges to the right, or to the left.
export type Turn = { from: Point; to: Point; bulge?: number };

// `entry` and `exit` are tracks, from left to right; `x` is the middle.
type Bend = { net: string; column: number; entry: number; exit: number; x: number };

// The least length of a turn, and the part of its height that it is long.
const LENGTH = { least: 44, slope: 0.6 };

// How far the control points of a turn around an end lie beside it.
export const BULGE = 32;
// The part of it that the turn itself reaches, and what it keeps clear of boxes.
const REACHED = 0.75;
const NEAR = 2;

// Ports lie so far outside of their boxes.
const OUT = 6;

// Whether a wire goes around: its target is not to the right.
export function goesBack(from: Point, to: Point): boolean {
  return to.x < from.x + 16;
}

// The turns of each wire, in its direction. The first and the last of a wire back lead around its ends.
export function turns(wires: WireLine[], routes: Map<string, Route>, tracks: Tracks): Map<string, Turn[]> {
  const own = new Map<string, Bend[]>();
  for (const wire of wires) {
    const route = routes.get(wire.id);
    own.set(wire.id, route === undefined ? [] : bends(wire, route, tracks));
  }
  const columns = new Map<number, Bend[]>();
  for (const bend of [...own.values()].flat()) {
    columns.set(bend.column, [...(columns.get(bend.column) ?? []), bend]);
  }
  for (const [column, list] of columns) {
    spread(list, tracks.left(column), tracks.right(column));
  }
  return new Map(
    wires.flatMap((wire) => {
      const route = routes.get(wire.id);
      return route === undefined ? [] : [[wire.id, drawn(wire, route, own.get(wire.id) ?? [], tracks)]];
    }),
  );
}

// The columns of a wire back beside its ends, where it turns round: their number at its begin and at its end.
function beside({ from, to }: WireLine, { columns }: Route, tracks: Tracks): [number, number] {
  const begin = columns.findIndex((column) => tracks.left(column) < from.x - OUT);
  const end = columns.toReversed().findIndex((column) => tracks.right(column) > to.x + OUT);
  return goesBack(from, to) ? [Math.max(1, begin), Math.max(1, end)] : [0, 0];
}

function bends(wire: WireLine, route: Route, tracks: Tracks): Bend[] {
  const { columns, enters, leaves } = route;
  const back = goesBack(wire.from, wire.to);
  const [begin, end] = beside(wire, route, tracks);
  return columns.flatMap((column, i) => {
    const [enter, leave] = [enters[i] ?? 0, leaves[i] ?? 0];
    return enter === leave || i < begin || i >= columns.length - end
      ? []
      : [{ net: wire.net, column, entry: back ? leave : enter, exit: back ? enter : leave, x: 0 }];
  });
}

// Bends of one column cross least if, from left to right, those that go down begin with the lowest, and those
// that go up with the highest.
function spread(list: Bend[], left: number, right: number): void {
  const down = list.filter(({ entry, exit }) => entry < exit);
  const up = list.filter(({ entry, exit }) => entry > exit);
  down.sort((a, b) => b.entry - a.entry || b.exit - a.exit);
  up.sort((a, b) => a.entry - b.entry || a.exit - b.exit);
  for (const half of [down, up]) {
    const nets = [...new Set(half.map(({ net }) => net))];
    for (const bend of half) {
      bend.x = left + ((right - left) * (nets.indexOf(bend.net) + 1)) / (nets.length + 1);
    }
  }
}

function drawn(wire: WireLine, route: Route, own: Bend[], tracks: Tracks): Turn[] {
  const { from, to } = wire;
  const back = goesBack(from, to);
  const [begun, ended] = beside(wire, route, tracks);
  const first = back ? tracks.height(route.leaves[begun - 1] ?? 0) : from.y;
  const last = back ? tracks.height(route.enters.at(-ended) ?? 0) : to.y;
  let y = first;
  const inner = own.map((bend, i) => {
    const next = i === own.length - 1 ? last : tracks.height(back ? bend.entry : bend.exit);
    const half = Math.max(LENGTH.least, LENGTH.slope * Math.abs(next - y)) / 2;
    const passed: [number, number] = [Math.min(bend.entry, bend.exit), Math.max(bend.entry, bend.exit)];
    const free = tracks.free(bend.column, passed, bend.x - half, bend.x + half);
    const [begin, end] = back ? [free.to, free.from] : [free.from, free.to];
    const turn = { from: { x: begin, y }, to: { x: end, y: next } };
    y = next;
    return turn;
  });
  separate(inner, back ? -1 : 1);
  if (!back) {
    for (const turn of inner) {
      turn.from.x = Math.max(turn.from.x, from.x);
      turn.to.x = Math.min(turn.to.x, to.x);
    }
    return inner;
  }
  const [begin, end] = [route.columns[0] ?? 0, route.columns.at(-1) ?? 0];
  return [
    round(tracks, begin, Math.max(from.x, tracks.left(begin)), [from.y, first], 1),
    ...inner,
    round(tracks, end, Math.min(to.x, tracks.right(end)), [y, to.y], -1),
  ];
}

// A turn around an end, as far as there is room for it.
function round(tracks: Tracks, column: number, x: number, [y, next]: [number, number], side: 1 | -1): Turn {
  const passed: [number, number] = [tracks.trackAt(Math.min(y, next)), tracks.trackAt(Math.max(y, next))];
  const far = x + side * BULGE * REACHED;
  const free = tracks.free(column, passed, Math.min(x, far), Math.max(x, far));
  const reached = Math.max(NEAR, side > 0 ? free.to - x : x - free.from) - NEAR;
  return { from: { x, y }, to: { x, y: next }, bulge: (side * reached) / REACHED };
}

// A turn ends before the next one begins.
function separate(own: Turn[], sign: 1 | -1): void {
  own.slice(1).forEach((turn, i) => {
    const before = own[i] as Turn;
    if ((turn.from.x - before.to.x) * sign < 0) {
      const x = (turn.from.x + before.to.x) / 2;
      before.to.x = x;
      turn.from.x = x;
    }
  });
}
