// The place on a wire of what is drawn there: its couplings, or the number of connections.

import type { Point, Rect } from "../layout/rects";
import { meet } from "../layout/rects";
import type { Turn } from "../wires/turns";

// `room` is the width of its label; 0: it has none.
export type LabelledWire = { id: string; from: Point; to: Point; turns: Turn[]; room: number };

type Piece = { id: string; from: Point; to: Point };

// The height of a label: near, and where it grows against the zoom.
const HEIGHT = { near: 22, far: 44 };
const FRACTIONS = [0.5, 0.3, 0.7, 0.15, 0.85];

// The widest first, each label is at the first place of its wire that covers no box and no other label, and
// that its wire has for itself.
export function labelPlaces(wires: LabelledWire[], boxes: Rect[]): Map<string, Point> {
  const lines = new Map<number, Piece[]>();
  for (const piece of wires.flatMap(pieces).filter(isStraight)) {
    const line = Math.round(piece.from.y);
    lines.set(line, [...(lines.get(line) ?? []), piece]);
  }
  const shared = (wire: string, { x, y }: Point) =>
    lines.get(Math.round(y))?.some(({ id, from, to }) => id !== wire && (x - from.x) * (x - to.x) <= 0) ===
    true;
  const taken: Rect[] = [];
  return new Map(
    wires
      .filter(({ room }) => room > 0)
      .sort((one, other) => other.room - one.room)
      .map((wire) => {
        const free = (place: Point, height: number) => {
          const own = around(place, wire.room, height);
          return !taken.some((one) => meet(own, one)) && !boxes.some((box) => meet(own, box));
        };
        const all = places(wire);
        const alone = all.filter((place) => !shared(wire.id, place));
        const place =
          alone.find((one) => free(one, HEIGHT.far)) ??
          alone.find((one) => free(one, HEIGHT.near)) ??
          all.find((one) => free(one, HEIGHT.near)) ??
          (all[0] as Point);
        taken.push(around(place, wire.room, HEIGHT.near));
        return [wire.id, place];
      }),
  );
}

// Places on a wire: those on its longest straight pieces first.
export function places(wire: Omit<LabelledWire, "room">): Point[] {
  const all = pieces(wire);
  const length = ({ from, to }: Piece) => Math.abs(to.x - from.x);
  const straight = all.filter(isStraight).sort((a, b) => length(b) - length(a));
  const at = ({ from, to }: Piece, part: number) => ({
    x: from.x + part * (to.x - from.x),
    y: from.y + part * (to.y - from.y),
  });
  return [
    ...straight.flatMap((piece) => FRACTIONS.map((part) => at(piece, part))),
    ...all.filter((piece) => !isStraight(piece)).map((piece) => at(piece, 0.5)),
  ];
}

function pieces({ id, from, to, turns }: Omit<LabelledWire, "room">): Piece[] {
  const ends = [from, ...turns.flatMap((turn) => [turn.from, turn.to]), to];
  return ends
    .slice(1)
    .map((end, i) => ({ id, from: ends[i] as Point, to: end }))
    .filter((piece) => piece.from.x !== piece.to.x || piece.from.y !== piece.to.y);
}

function isStraight({ from, to }: Piece): boolean {
  return from.y === to.y;
}

function around({ x, y }: Point, width: number, height: number): Rect {
  return { x: x - width / 2, y: y - height / 2, width, height };
}
