// The place on a wire of what is drawn there: its couplings, its strength, or the number of connections. It
// slides along the wire to where it covers no box and nothing on another wire.

import type { Point, Rect } from "../model/rects";
import { meet } from "../model/rects";
import type { Turn } from "./turns";

// `room` is the width of its label; 0: it has none.
export type LabelledWire = { id: string; from: Point; to: Point; turns: Turn[]; room: number };

// `beside`: where the control points of a turn lie; it is straight where both ends have one height.
type Piece = { id: string; from: Point; to: Point; beside: number };

// The height of a label: near, and where it grows against the zoom.
const HEIGHT = { near: 22, far: 44 };
// Labels that grow in width too.
const SMALL = 40;
const FRACTIONS = [0.5, 0.3, 0.7, 0.15, 0.85];
// The distance of places along a wire.
const STEP = 6;
// A label that finds no place on its wire may lie beside it, where it still touches it.
const ASIDE = { up: [0, -6, 6, -10, 10], across: [-0.4, 0.4] };
// How far from its ends a wire is taken by a hand.
const END = 20;
// How often a label makes way for others without a place.
const MOST_MOVED = 5;

// Those with the fewest places first, each label is at the first place of its wire that covers no box and no
// other label, and that its wire has for itself.
export function labelPlaces(wires: LabelledWire[], boxes: Rect[]): Map<string, Point> {
  return new Labels(wires, boxes).placed();
}

// A place of a label, and what it covers there.
type LabelSpot = { place: Point; rect: Rect };

class Labels {
  private readonly lines = new Map<number, Piece[]>();
  private readonly taken = new Map<string, Rect>();
  private readonly labelled: LabelledWire[];
  private readonly moves = new Map<string, number>();

  constructor(
    wires: LabelledWire[],
    private readonly boxes: Rect[],
  ) {
    for (const piece of wires.flatMap(pieces).filter(isStraight)) {
      const line = Math.round(piece.from.y);
      this.lines.set(line, [...(this.lines.get(line) ?? []), piece]);
    }
    this.labelled = wires.filter(({ room }) => room > 0);
  }

  placed(): Map<string, Point> {
    const found = new Map<string, Point>();
    const tight = new Map(this.labelled.map((wire) => [wire.id, wire.room - lengthOf(wire)]));
    const waiting = this.labelled.toSorted((a, b) => (tight.get(b.id) ?? 0) - (tight.get(a.id) ?? 0));
    for (let wire = waiting.shift(); wire !== undefined; wire = waiting.shift()) {
      const free = this.free(wire);
      const { place, rect } = free ?? this.least(wire);
      // Others make way, a limited number of times.
      for (const id of free === null ? this.below(rect) : []) {
        const moved = (this.moves.get(id) ?? 0) + 1;
        if (moved <= MOST_MOVED) {
          this.moves.set(id, moved);
          this.taken.delete(id);
          waiting.push(...this.labelled.filter((other) => other.id === id));
        }
      }
      found.set(wire.id, place);
      this.taken.set(wire.id, sized(place, wire.room, "near"));
    }
    return found;
  }

  private free(wire: LabelledWire): LabelSpot | null {
    for (const spot of this.spots(wire)) {
      if (this.below(spot.rect).length === 0) {
        return spot;
      }
    }
    return null;
  }

  // The places of a label that cover no box, the best first.
  private *spots(wire: LabelledWire): Generator<LabelSpot> {
    const reached = around(extent(wire), wire.room + HEIGHT.far);
    const boxes = this.boxes.filter((box) => meet(box, reached));
    const coarse = places(wire);
    const alone = coarse.filter((place) => !this.isShared(wire.id, place));
    const tried: [Point[], LabelSize][] = [
      [alone, "far"],
      [alone, "near"],
      [coarse, "near"],
      [aside([...coarse, ...along(wire)], wire.room), "near"],
    ];
    // A hand takes a wire at its ends, which a label leaves free where it can.
    for (const covered of [[...boxes, ...endsOf(wire)], boxes]) {
      for (const [all, size] of tried) {
        yield* spotsAt(all, wire.room, size, covered);
      }
    }
  }

  // The place that covers the fewest labels, of which those that moved often count more.
  private least(wire: LabelledWire): LabelSpot {
    const [first = wire.from] = places(wire);
    const cost = ({ rect }: LabelSpot) =>
      this.below(rect).reduce((sum, id) => sum + 1 + (this.moves.get(id) ?? 0), 0);
    const costs = [...this.spots(wire)].map((spot) => ({ spot, cost: cost(spot) }));
    const best = costs.reduce<(typeof costs)[0] | null>(
      (a, b) => (a !== null && a.cost <= b.cost ? a : b),
      null,
    );
    return best?.spot ?? { place: first, rect: sized(first, wire.room, "near") };
  }

  private below(rect: Rect): string[] {
    return [...this.taken].flatMap(([id, other]) => (meet(rect, other) ? [id] : []));
  }

  private isShared(wire: string, { x, y }: Point): boolean {
    const line = this.lines.get(Math.round(y));
    return line?.some(({ id, from, to }) => id !== wire && (x - from.x) * (x - to.x) <= 0) === true;
  }
}

function* spotsAt(all: Point[], room: number, size: LabelSize, boxes: Rect[]): Generator<LabelSpot> {
  for (const place of all) {
    const rect = sized(place, room, size);
    if (!boxes.some((box) => meet(rect, box))) {
      yield { place, rect };
    }
  }
}

type LabelSize = keyof typeof HEIGHT;

// Places on a wire: those on its longest straight pieces first.
export function places(wire: Omit<LabelledWire, "room">): Point[] {
  const all = pieces(wire);
  const length = ({ from, to }: Piece) => Math.abs(to.x - from.x);
  const straight = all.filter(isStraight).sort((a, b) => length(b) - length(a));
  return [
    ...straight.flatMap((piece) => FRACTIONS.map((part) => pointAt(piece, part))),
    ...all.filter((piece) => !isStraight(piece)).map((piece) => pointAt(piece, 0.5)),
  ];
}

// Places all along a wire, the nearest to the best one first.
function along(wire: LabelledWire): Point[] {
  const [best = wire.from] = places(wire);
  const far = ({ x, y }: Point) => Math.hypot(x - best.x, y - best.y);
  return pieces(wire)
    .flatMap((piece) => {
      const count = Math.ceil(Math.hypot(piece.to.x - piece.from.x, piece.to.y - piece.from.y) / STEP) + 1;
      return Array.from({ length: count + 1 }, (_, i) => pointAt(piece, i / count));
    })
    .sort((a, b) => far(a) - far(b));
}

function aside(all: Point[], room: number): Point[] {
  const shifts = [
    ...ASIDE.up.map((y) => ({ x: 0, y })),
    ...ASIDE.across.map((part) => ({ x: part * room, y: 0 })),
  ];
  return shifts.flatMap((shift) => all.map(({ x, y }) => ({ x: x + shift.x, y: y + shift.y })));
}

function pointAt({ from, to, beside }: Piece, part: number): Point {
  const rest = 1 - part;
  const [begin, end] = [rest ** 3 + 3 * rest * rest * part, part ** 3 + 3 * rest * part * part];
  return isStraight({ from, to })
    ? { x: from.x + part * (to.x - from.x), y: from.y }
    : {
        x: rest ** 3 * from.x + 3 * rest * part * beside + part ** 3 * to.x,
        y: begin * from.y + end * to.y,
      };
}

function pieces({ id, from, to, turns }: Omit<LabelledWire, "room">): Piece[] {
  const bent = turns.map((turn): Piece => {
    const beside = turn.bulge === undefined ? (turn.from.x + turn.to.x) / 2 : turn.from.x + turn.bulge;
    return { id, from: turn.from, to: turn.to, beside };
  });
  const ends = [from, ...turns.flatMap((turn) => [turn.from, turn.to]), to];
  const straight = Array.from({ length: turns.length + 1 }, (_, i): Piece => {
    const [begin, end] = [ends[2 * i] ?? from, ends[2 * i + 1] ?? to];
    return { id, from: begin, to: end, beside: begin.x };
  });
  return [...straight, ...bent].filter((piece) => piece.from.x !== piece.to.x || piece.from.y !== piece.to.y);
}

function isStraight({ from, to }: Pick<Piece, "from" | "to">): boolean {
  return from.y === to.y;
}

const lengthOf = (wire: LabelledWire): number =>
  pieces(wire).reduce((sum, { from, to }) => sum + Math.hypot(to.x - from.x, to.y - from.y), 0);

function extent(wire: LabelledWire): Rect {
  const all = pieces(wire).flatMap(({ from, to, beside }) => [from, to, { x: beside, y: from.y }]);
  const [x, y] = [Math.min(...all.map((one) => one.x)), Math.min(...all.map((one) => one.y))];
  return {
    x,
    y,
    width: Math.max(...all.map((one) => one.x)) - x,
    height: Math.max(...all.map((one) => one.y)) - y,
  };
}

const endsOf = ({ from, to }: LabelledWire): Rect[] =>
  [from, to].map(({ x, y }) => around({ x, y, width: 0, height: 0 }, END));

const around = ({ x, y, width, height }: Rect, by: number): Rect => ({
  x: x - by,
  y: y - by,
  width: width + 2 * by,
  height: height + 2 * by,
});

function sized({ x, y }: Point, room: number, size: LabelSize): Rect {
  const height = HEIGHT[size];
  const width = size === "far" && room <= SMALL ? 2 * room : room;
  return { x: x - width / 2, y: y - height / 2, width, height };
}
