// The layout: boxes at the positions of the document, the others by dagre from left to right, group by group
// from inside out, in the shape of the canvas.

import { Graph, layout as arrange } from "@dagrejs/dagre";
import type { Branch } from "./tree";
import { meet, type Point, type Rect, type Size } from "../model/rects";
import { squeezed } from "./squeeze";
import { wrapped } from "./wrap";

// Two elements that belong side by side; `room` is the width that its pills need.
export type Bond = { source: string; target: string; room: number };

// `whole` is the size of everything that is visible.
export type Places = { elements: Map<string, Point>; groups: Map<string, Rect>; whole: Size };

export const FRAME = { side: 28, top: 40, bottom: 40 };
export const FOLDED: Size = { width: 168, height: 64 };
// The size of the canvas where it is not known.
export const PANEL: Size = { width: 950, height: 400 };

// The width of the number of connections that an edge stands for.
export const COUNT = 24;

// Gaps between boxes; edges and pills take little room between the boxes that they pass, because room makes
// all boxes smaller.
const GAP = { rank: 40, node: 24, pill: 4, edge: 4, apart: 24 };

type Item = { id: string; rect: Rect; placed: boolean; inner: Laid | null; group: Branch | null };
type Laid = { items: Item[]; rect: Rect; placed: boolean };

// Positions on the canvas of all elements, also of those inside folded groups, and the rectangles of all
// groups. `panel` is the size of the canvas.
export function places(
  root: Branch,
  sizes: Map<string, Size>,
  bonds: Bond[],
  boxes: Map<string, Point>,
  panel: Size = PANEL,
): Places {
  const laid = level(root, sizes, bonds, boxes, panel);
  const whole = {
    width: laid.rect.width - 2 * FRAME.side,
    height: laid.rect.height - FRAME.top - FRAME.bottom,
  };
  const found: Places = { elements: new Map(), groups: new Map(), whole };
  collect(laid, { x: 0, y: 0 }, found);
  return found;
}

function level(
  branch: Branch,
  sizes: Map<string, Size>,
  bonds: Bond[],
  boxes: Map<string, Point>,
  panel: Size,
): Laid {
  const items: Item[] = branch.elements.map((id) => {
    const box = boxes.get(id);
    return {
      id,
      rect: { ...(box ?? { x: 0, y: 0 }), ...sizeOf(sizes, id) },
      placed: box !== undefined,
      inner: null,
      group: null,
    };
  });
  for (const group of branch.groups) {
    const inner = level(group, sizes, bonds, boxes, panel);
    const frame = { ...inner.rect, ...(group.folded ? FOLDED : {}) };
    items.push({ id: group.key, rect: frame, placed: inner.placed, inner, group });
  }
  const placed = items.some((item) => item.placed);
  spread(items, lifted(branch, bonds), panel);
  makeRoom(items);
  return { items, rect: frameAround(items), placed };
}

// Uses dagre for the items without a position; items with a position keep it, and the others are placed
// relative to them.
function spread(items: Item[], bonds: Bond[], panel: Size): void {
  const free = items.filter((item) => !item.placed);
  if (free.length === 0) {
    return;
  }
  const wished = byDagre(items, bonds, panel);
  const fixed = items.filter((item) => item.placed);
  const mean = (of: (item: Item) => number) =>
    fixed.reduce((sum, item) => sum + of(item), 0) / Math.max(1, fixed.length);
  const dx = mean((item) => item.rect.x - (wished.get(item.id)?.x ?? 0));
  const dy = mean((item) => item.rect.y - (wished.get(item.id)?.y ?? 0));
  const taken = fixed.map((item) => item.rect);
  for (const item of free) {
    const wish = wished.get(item.id) ?? { x: 0, y: 0 };
    moveTo(item, wish.x + dx, wish.y + dy);
    for (let hit = taken.find((rect) => meet(rect, item.rect)); fixed.length > 0 && hit !== undefined;) {
      moveTo(item, item.rect.x, hit.y + hit.height + GAP.apart);
      hit = taken.find((rect) => meet(rect, item.rect));
    }
    taken.push(item.rect);
  }
}

function byDagre(items: Item[], bonds: Bond[], panel: Size): Map<string, Point> {
  const graph = new Graph({ multigraph: true });
  graph.setGraph({
    rankdir: "LR",
    ranksep: GAP.rank,
    nodesep: GAP.node,
    edgesep: GAP.edge,
    acyclicer: "greedy",
  });
  for (const { id, rect } of items) {
    graph.setNode(id, { width: rect.width, height: rect.height });
  }
  bonds.forEach(({ source, target, room }, i) => {
    if (source !== target) {
      graph.setEdge(
        source,
        target,
        room > 0 ? { width: room, height: GAP.pill, labelpos: "c" } : { width: 0, height: 0 },
        String(i),
      );
    }
  });
  arrange(graph);
  const found = new Map(
    items.map(({ id, rect }) => {
      const { x = 0, y = 0 } = graph.node(id) as Partial<Point>;
      return [id, { x: Math.round(x - rect.width / 2), y: Math.round(y - rect.height / 2) }];
    }),
  );
  const sizes = new Map(items.map(({ id, rect }) => [id, rect]));
  return wrapped(squeezed(found, sizes, GAP.node), sizes, panel);
}

// Bonds between the items of this level: those of elements deeper inside count for the group around them.
function lifted(branch: Branch, bonds: Bond[]): Bond[] {
  const item = new Map<string, string>(branch.elements.map((id) => [id, id]));
  const claim = (group: Branch, as: string): void => {
    group.elements.forEach((id) => item.set(id, as));
    group.groups.forEach((inner) => claim(inner, as));
  };
  branch.groups.forEach((group) => claim(group, group.key));
  // Several between the same two items take the place of one, and have no pills where they end at a folded
  // group, which shows their number.
  const folded = new Set(branch.groups.filter((group) => group.folded).map((group) => group.key));
  const merged = new Map<string, Bond>();
  for (const { source, target, room } of bonds) {
    const [from, to] = [item.get(source), item.get(target)];
    if (from !== undefined && to !== undefined) {
      const key = JSON.stringify([from, to]);
      const known = merged.get(key);
      const own = known !== undefined && (folded.has(from) || folded.has(to)) ? COUNT : room;
      merged.set(key, { source: from, target: to, room: Math.max(own, known?.room ?? 0) });
    }
  }
  return [...merged.values()];
}

// An open group that grew (unfolded, or with a new element) moves the items that it covers to the right or
// down, by the smaller distance.
function makeRoom(items: Item[]): void {
  const order = [...items].sort((a, b) => a.rect.x - b.rect.x || a.rect.y - b.rect.y);
  const settled: Item[] = [];
  for (const item of order) {
    for (let hit = blocking(settled, item); hit !== undefined; hit = blocking(settled, item)) {
      const right = hit.rect.x + hit.rect.width + GAP.apart;
      const down = hit.rect.y + hit.rect.height + GAP.apart;
      if (right - item.rect.x <= down - item.rect.y) {
        moveTo(item, right, item.rect.y);
      } else {
        moveTo(item, item.rect.x, down);
      }
    }
    settled.push(item);
  }
}

function blocking(settled: Item[], item: Item): Item | undefined {
  const frame = (one: Item) => one.group !== null && !one.group.folded;
  return settled.find((other) => (frame(item) || frame(other)) && meet(other.rect, item.rect));
}

function collect(laid: Laid, shift: Point, found: Places): void {
  for (const { id, rect, inner } of laid.items) {
    const at = { x: rect.x + shift.x, y: rect.y + shift.y };
    if (inner === null) {
      found.elements.set(id, at);
    } else {
      found.groups.set(id, { ...rect, ...at });
      collect(inner, { x: at.x - inner.rect.x, y: at.y - inner.rect.y }, found);
    }
  }
}

function frameAround(items: Item[]): Rect {
  if (items.length === 0) {
    return { x: 0, y: 0, width: FOLDED.width, height: FOLDED.height };
  }
  const x = Math.min(...items.map(({ rect }) => rect.x)) - FRAME.side;
  const y = Math.min(...items.map(({ rect }) => rect.y)) - FRAME.top;
  const right = Math.max(...items.map(({ rect }) => rect.x + rect.width)) + FRAME.side;
  const bottom = Math.max(...items.map(({ rect }) => rect.y + rect.height)) + FRAME.bottom;
  return { x, y, width: Math.max(right - x, FOLDED.width), height: bottom - y };
}

function moveTo(item: Item, x: number, y: number): void {
  item.rect = { ...item.rect, x, y };
}

function sizeOf(sizes: Map<string, Size>, id: string): Size {
  return sizes.get(id) ?? FOLDED;
}
