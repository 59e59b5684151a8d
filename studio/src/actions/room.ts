// A box that is inserted into a connection makes room: what lies downstream moves right by what is missing,
// and pushes on what it comes too near to. Nothing else moves.

import { rectsOf, type SceneNode, type Wire } from "../architecture/nodes";
import { FRAME, type Places } from "../architecture/layout";
import { moved } from "../architecture/moved";
import type { Point, Rect, Size } from "../model/rects";
import { commentId, groupKey, groupNode, type GraphScene } from "../architecture/scene";
import { roomOf } from "../architecture/courses";
import { exactly, groupAt, type Moves, type Placing } from "./placing";

// `side`: between the box and the ends of its connection; `chip`: what a number on a wire leaves of it;
// `apart`: what a box that moves keeps from others.
const GAP = { side: 36, chip: 16, apart: 24 };

export type RoomyPlacing = Placing & { moves: Moves };

// A box with its corner near a point of a connection; null: the connection does not lead to the right.
// `dragged`: the box, where it exists already.
export function onWire(
  wire: Wire,
  corner: Point,
  size: Size,
  scene: GraphScene,
  dragged?: string,
): RoomyPlacing | null {
  const nodes = scene.nodes.filter(({ id }) => id !== dragged);
  const levels = new Levels(nodes, scene);
  const ends = levels.endsOf(wire.source, wire.target);
  if (ends === null) {
    return null;
  }
  const { level, source, target } = ends;
  const [from, to] = [levels.rect(source), levels.rect(target)];
  const [left, right] = [
    from.x + from.width + GAP.side,
    to.x - Math.max(GAP.side, roomOf(wire.data) + GAP.chip),
  ];
  if (to.x < from.x + from.width) {
    return null;
  }
  const missing = Math.max(0, left + size.width - right);
  if (missing > 0) {
    levels.move(level, downstream(target, source, level, levels, scene.wires), missing);
  }
  const at = {
    x: Math.max(left, Math.min(corner.x, right + missing - size.width)),
    y: [from.y, to.y].find((y) => Math.abs(y - corner.y) <= GAP.side) ?? corner.y,
  };
  const after = levels.shifted();
  const boxes = moved(after, scene.tree, scene.places);
  const places = { ...scene.places, elements: boxes, groups: levels.frames(scene.places) };
  const placing = exactly(at, size, level === "" ? "" : groupKey(level), { ...scene, places });
  const comments = after.flatMap(({ id, type, position }) =>
    type === "comment" ? [[commentId(id), position] as const] : [],
  );
  return { ...placing, moves: { boxes, comments: new Map(comments) } };
}

// What is reached from a box or a group through connections to the right.
function downstream(start: string, without: string, level: string, levels: Levels, wires: Wire[]): string[] {
  const links = wires.flatMap((wire): [string, string][] => {
    const [one, other] = [levels.within(wire.source, level), levels.within(wire.target, level)];
    return one === null || other === null || one === other ? [] : [[one, other]];
  });
  const reached = new Set([start]);
  for (const one of reached) {
    const { x, width } = levels.rect(one);
    for (const [source, target] of links) {
      if (source === one && target !== without && levels.rect(target).x >= x + width) {
        reached.add(target);
      }
    }
  }
  return [...reached];
}

// What moves and grows to the right: boxes, groups and comments by the id of their node, in the group around.
class Levels {
  private readonly rects: Map<string, Rect>;
  private readonly home: Map<string, string>;
  private readonly shifts = new Map<string, number>();
  private readonly growths = new Map<string, number>();

  constructor(
    private readonly nodes: SceneNode[],
    scene: GraphScene,
  ) {
    this.rects = rectsOf(nodes);
    this.home = new Map(
      nodes.map(({ id, type, parentId = "" }) => {
        const { x, y, width, height } = this.rect(id);
        const group = type !== "comment" ? "" : groupAt({ x: x + width / 2, y: y + height / 2 }, scene);
        return [id, group === "" ? parentId : groupNode(group)];
      }),
    );
  }

  rect(id: string): Rect {
    return this.rects.get(id) ?? { x: 0, y: 0, width: 0, height: 0 };
  }

  // The node in a group that is another one, or holds it; null: none is.
  within(id: string, level: string): string | null {
    for (let node: string | undefined = id; node !== undefined; node = this.home.get(node)) {
      if (this.home.get(node) === level) {
        return node;
      }
    }
    return null;
  }

  // The innermost group around two nodes, and what of it they are in.
  endsOf(one: string, other: string): { level: string; source: string; target: string } | null {
    for (let level = this.home.get(one); level !== undefined; level = this.home.get(level)) {
      const [source, target] = [this.within(one, level), this.within(other, level)];
      if (source !== null && target !== null) {
        return source === target ? null : { level, source, target };
      }
    }
    return null;
  }

  // Nodes of a group move; the others there, and beside the groups that grow around them, are pushed on.
  move(level: string, ids: string[], by: number): void {
    ids.forEach((id) => this.shifts.set(id, by));
    this.push(level);
    const frame = this.rects.get(level);
    const outer = this.home.get(level);
    if (frame === undefined || outer === undefined) {
      return;
    }
    const edge = Math.max(...this.inside(level).map((id) => this.right(id))) + FRAME.side;
    this.growths.set(level, Math.max(0, edge - frame.x - frame.width));
    this.move(outer, [], 0);
  }

  // All nodes at their new positions, in the group around.
  shifted(): SceneNode[] {
    return this.nodes.map((node) => {
      const outer = node.type === "comment" ? this.ofAll(this.home.get(node.id) ?? "") : 0;
      const by = outer + (this.shifts.get(node.id) ?? 0);
      return by === 0 ? node : { ...node, position: { ...node.position, x: node.position.x + by } };
    });
  }

  frames({ groups }: Places): Map<string, Rect> {
    return new Map(
      [...groups].map(([key, rect]) => {
        const id = groupNode(key);
        return [
          key,
          { ...rect, x: rect.x + this.ofAll(id), width: rect.width + (this.growths.get(id) ?? 0) },
        ];
      }),
    );
  }

  // How far a node moves with the groups around it.
  private ofAll(id: string): number {
    const outer = this.home.get(id);
    return (this.shifts.get(id) ?? 0) + (outer === undefined ? 0 : this.ofAll(outer));
  }

  private inside(level: string): string[] {
    return [...this.home].flatMap(([id, home]) => (home === level ? [id] : []));
  }

  private right(id: string): number {
    const { x, width } = this.rect(id);
    return x + width + (this.shifts.get(id) ?? 0) + (this.growths.get(id) ?? 0);
  }

  private push(level: string): void {
    const isComment = new Set(this.nodes.flatMap(({ id, type }) => (type === "comment" ? [id] : [])));
    const inside = this.inside(level).sort((a, b) => this.rect(a).x - this.rect(b).x);
    const boxes = inside.filter((id) => !isComment.has(id));
    for (const id of boxes) {
      this.pushed(id, boxes);
    }
    // A comment belongs to what is nearest to it.
    for (const id of inside.filter((one) => isComment.has(one))) {
      const distance = (other: string) => apart(this.rect(other), this.rect(id));
      const nearest = boxes.toSorted((one, other) => distance(one) - distance(other))[0] ?? "";
      this.shifts.set(id, this.shifts.get(nearest) ?? 0);
      this.pushed(id, boxes);
    }
  }

  // A node keeps its distance from what comes nearer from the left, as far as that is not more than needed.
  private pushed(id: string, boxes: string[]): void {
    const own = this.rect(id);
    for (const other of boxes) {
      const rect = this.rect(other);
      const gap = own.x - rect.x - rect.width;
      const isBeside = own.y < rect.y + rect.height + GAP.apart && rect.y < own.y + own.height + GAP.apart;
      if (other !== id && gap >= 0 && isBeside && this.right(other) > rect.x + rect.width) {
        const least = this.right(other) + Math.min(gap, GAP.apart) - own.x;
        this.shifts.set(id, Math.max(this.shifts.get(id) ?? 0, least));
      }
    }
  }
}

// The distance between two rectangles.
function apart(a: Rect, b: Rect): number {
  return Math.hypot(
    Math.max(0, a.x - b.x - b.width, b.x - a.x - a.width),
    Math.max(0, a.y - b.y - b.height, b.y - a.y - a.height),
  );
}
