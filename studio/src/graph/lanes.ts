// The course of each edge, so that edges side by side do not overlap.

import type { Rect } from "./layout";
import type { Wire } from "./scene";
import { goesBack } from "./wirePath";

type Run = { from: number; to: number; y: number; lane: number };

// Edges closer than this to each other could be mistaken for one.
const NEAR = 70;

// Edges ahead count among those between the same two nodes; edges back among those that run below the same
// stretch, the short ones first.
export function lanes(wires: Wire[], rectOf: (node: string) => Rect): void {
  const pairs = new Map<string, number>();
  const back: { wire: Wire; run: Run }[] = [];
  for (const wire of wires) {
    const [source, target] = [rectOf(wire.source), rectOf(wire.target)];
    if (goesBack({ x: source.x + source.width, y: source.y }, target)) {
      const y = Math.max(source.y + source.height, target.y + target.height);
      back.push({ wire, run: { from: target.x, to: source.x + source.width, y, lane: 0 } });
    } else {
      const pair = [wire.source, wire.target].join(" ");
      const lane = pairs.get(pair) ?? 0;
      pairs.set(pair, lane + 1);
      put(wire, lane);
    }
  }
  const settled: Run[] = [];
  for (const { wire, run } of back.sort((a, b) => a.run.to - a.run.from - (b.run.to - b.run.from))) {
    const taken = new Set(
      settled
        .filter((other) => other.from <= run.to && run.from <= other.to && Math.abs(other.y - run.y) < NEAR)
        .map(({ lane }) => lane),
    );
    while (taken.has(run.lane)) {
      run.lane += 1;
    }
    settled.push(run);
    put(wire, run.lane);
  }
}

function put(wire: Wire, lane: number): void {
  if (wire.data !== undefined) {
    wire.data.lane = lane;
  }
}
