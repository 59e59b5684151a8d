// The path of a wire.

import type { Point } from "../model/rects";
import { places } from "./labels";
import { BULGE, goesBack, type Turn } from "./turns";

export type Course = { from: Point; to: Point; path: string; middle: Point };

// A wire back whose end moves runs so far below both.
const BELOW = 60;

// A wire whose ends are being moved goes straight.
export function direct(from: Point, to: Point): Course {
  if (goesBack(from, to)) {
    const y = Math.max(from.y, to.y) + BELOW;
    return courseOf(from, to, [
      { from, to: { x: from.x, y }, bulge: BULGE },
      { from: { x: to.x, y }, to, bulge: -BULGE },
    ]);
  }
  return courseOf(from, to, [{ from, to }]);
}

export function courseOf(from: Point, to: Point, turns: Turn[]): Course {
  const pieces = turns.map((turn) => {
    const x = turn.bulge === undefined ? (turn.from.x + turn.to.x) / 2 : turn.from.x + turn.bulge;
    return `L${at(turn.from)} C${at({ x, y: turn.from.y })} ${at({ x, y: turn.to.y })} ${at(turn.to)}`;
  });
  const path = [`M${at(from)}`, ...pieces, `L${at(to)}`].join(" ");
  return { from, to, path, middle: places({ id: "", from, to, turns })[0] ?? from };
}

const at = ({ x, y }: Point): string => `${x},${y}`;
