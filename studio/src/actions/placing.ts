// Where a new box is put: at the pointer, at the end of a wire, or beside what is selected; there, or in the
// nearest place without a box, a frame or a gap that is too small.

import { BOX, LIVE } from "../architecture/boxes";
import { FRAME, type Places } from "../architecture/layout";
import type { Point, Rect, Size } from "../model/rects";
import { type Branch, keyOf } from "../architecture/tree";
import type { GraphScene } from "../architecture/scene";
import type { DocumentView, Kind } from "../protocol";

export const NEW_BOX: Size = { width: BOX.width, height: BOX.title + LIVE.curve + BOX.pad };
const GAP = { side: 72, apart: 24 };
// New boxes lie on this grid.
const GRID = 12;
// A place above costs this much more than one below, so that several boxes stand below each other.
const ABOVE = 6;
// Further away than this no place is looked for: about five boxes.
const MOST_RINGS = 60;
// The pointer is at the name of a new box.
const HEAD = BOX.title / 2;

// Positions of boxes and of comments.
export type Moves = { boxes: Map<string, Point>; comments: Map<string, Point> };

// A position on the canvas, and the key of the group around it; `moves`: what makes room for it.
export type Placing = { at: Point; group: string; moves?: Moves };

type Scene = Pick<GraphScene, "tree" | "places" | "nodes">;

// The largest box that an element of a kind has: at most all of its ports lie at one side.
export function sizeOfKind(kind: Kind | undefined): Size {
  const ports = Object.keys(kind?.ports ?? {}).length;
  return { width: NEW_BOX.width, height: Math.max(NEW_BOX.height, BOX.port * (ports + 1)) };
}

// The path of a group by its key.
export function pathOf(
  key: string,
  { groups, elements }: Pick<DocumentView, "groups" | "elements">,
): string[] {
  const paths = [...groups, ...elements.map((e) => e.group)];
  for (const path of paths) {
    for (let depth = path.length; depth > 0; depth--) {
      if (keyOf(path.slice(0, depth)) === key) {
        return path.slice(0, depth);
      }
    }
  }
  return [];
}

// A box with its name below the pointer.
export function under(at: Point, scene: Scene, size = NEW_BOX): Placing {
  return free({ x: at.x - size.width / 2, y: at.y - HEAD }, size, groupAt(at, scene), scene);
}

// A box whose inputs (`right`) or outputs are at the end of a wire.
export function atEnd(at: Point, right: boolean, scene: Scene, size = NEW_BOX): Placing {
  const x = right ? at.x : at.x - size.width;
  return free({ x, y: at.y - size.height / 2 }, size, groupAt(at, scene), scene);
}

// Right or left of a box.
export function beside(element: string, right: boolean, scene: Scene, size = NEW_BOX): Placing {
  const at = scene.places.elements.get(element) ?? { x: 0, y: 0 };
  const x = right ? at.x + NEW_BOX.width + GAP.side : at.x - size.width - GAP.side;
  return free({ x, y: at.y }, size, scene.tree.home.get(element) ?? "", scene);
}

// Near a point of the canvas, such as its middle.
export function near(at: Point, scene: Scene, size = NEW_BOX): Placing {
  return free({ x: at.x - size.width / 2, y: at.y - size.height / 2 }, size, "", scene);
}

// Between two boxes.
export function between(one: string, other: string, scene: Scene, size = NEW_BOX): Placing {
  const [a, b] = [one, other].map((id) => scene.places.elements.get(id) ?? { x: 0, y: 0 }) as [Point, Point];
  const [first, second] = [one, other].map((id) => scene.tree.home.get(id) ?? "") as [string, string];
  return free({ x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 }, size, first === second ? first : "", scene);
}

// Right of everything, for a group of unknown size; null: there is nothing.
export function afterAll(scene: Scene): Placing | null {
  const taken = takenIn("", scene);
  if (taken.length === 0) {
    return null;
  }
  const right = Math.max(...taken.map(({ x, width }) => x + width));
  const top = Math.min(...taken.map(({ y }) => y));
  return { at: { x: snapped(right + GAP.side + FRAME.side), y: snapped(top + FRAME.top) }, group: "" };
}

// A rectangle of boxes with its corner at a point, or in the nearest free place: in the group, or outside of
// it where other boxes leave its frame no room to grow.
export function free(wish: Point, size: Size, group: string, scene: Scene): Placing {
  const frames = enclosures(group, scene);
  const at = freePlace(wish, size, (rect) => fitsIn(rect, frames));
  if (at !== null) {
    return { at, group };
  }
  return group === "" ? { at: wish, group } : free(wish, size, scene.tree.outer.get(group) ?? "", scene);
}

// At a point, where nothing is near it.
export function exactly(at: Point, size: Size, group: string, scene: Scene): Placing {
  const isFree = fitsIn({ ...at, ...size }, enclosures(group, scene));
  return isFree ? { at, group } : free(at, size, group, scene);
}

// The place of the grid that is nearest to a point; null: none near it is free.
export function freePlace(wish: Point, size: Size, isFree: (rect: Rect) => boolean): Point | null {
  const start = { x: snapped(wish.x), y: snapped(wish.y) };
  let best: { at: Point; cost: number } | null = null;
  for (let ring = 0; best === null ? ring < MOST_RINGS : ring * GRID <= best.cost; ring++) {
    for (const [column, row] of ringOf(ring)) {
      const at = { x: start.x + column * GRID, y: start.y + row * GRID };
      const cost = GRID * Math.hypot(column, row) + (row < 0 ? ABOVE : 0);
      if ((best === null || cost < best.cost) && isFree({ ...at, ...size })) {
        best = { at, cost };
      }
    }
  }
  return best?.at ?? null;
}

// What lies in a group, and around it: for each frame from the inner one outwards, its present rectangle and
// what it may not come near when it grows.
type Enclosure = { frame: Rect | null; taken: readonly Rect[] };

function enclosures(group: string, scene: Scene): Enclosure[] {
  const frame = scene.places.groups.get(group);
  const inside = takenIn(group, scene);
  const outer = scene.tree.outer.get(group);
  if (group === "" || frame === undefined || outer === undefined) {
    return [{ frame: null, taken: inside }];
  }
  const [above, ...further] = enclosures(outer, scene);
  const beside = (above?.taken ?? []).filter((rect) => !areNear(rect, frame));
  return [{ frame, taken: inside }, { frame: above?.frame ?? null, taken: beside }, ...further];
}

function fitsIn(rect: Rect, frames: readonly Enclosure[]): boolean {
  let grown = rect;
  for (const { frame, taken } of frames) {
    if (taken.some((other) => areNear(grown, other))) {
      return false;
    }
    grown = frame === null ? grown : around(frame, grown);
  }
  return true;
}

// A frame that has grown around a rectangle in it.
function around(frame: Rect, rect: Rect): Rect {
  const x = Math.min(frame.x, rect.x - FRAME.side);
  const y = Math.min(frame.y, rect.y - FRAME.top);
  const right = Math.max(frame.x + frame.width, rect.x + rect.width + FRAME.side);
  const bottom = Math.max(frame.y + frame.height, rect.y + rect.height + FRAME.bottom);
  return { x, y, width: right - x, height: bottom - y };
}

// The cells at a distance from a cell, as columns and rows from there.
function* ringOf(ring: number): Generator<[number, number]> {
  for (let k = -ring; k <= ring; k++) {
    yield [k, ring];
    if (ring > 0) {
      yield [k, -ring];
    }
  }
  for (let k = 1 - ring; k < ring; k++) {
    yield [ring, k];
    yield [-ring, k];
  }
}

export function areNear(a: Rect, b: Rect): boolean {
  return (
    a.x < b.x + b.width + GAP.apart &&
    b.x < a.x + a.width + GAP.apart &&
    a.y < b.y + b.height + GAP.apart &&
    b.y < a.y + a.height + GAP.apart
  );
}

// The boxes, frames and folded groups directly in a group.
function takenIn(group: string, { tree, places, nodes }: Scene): Rect[] {
  const branch = tree.groups.get(group) ?? tree.root;
  const sizes = new Map(nodes.map(({ id, width, height }) => [id, { width, height }]));
  const boxes = branch.elements.flatMap((id) => {
    const at = places.elements.get(id);
    const { width = NEW_BOX.width, height = NEW_BOX.height } = sizes.get(id) ?? {};
    return at === undefined ? [] : [{ ...at, width, height }];
  });
  return [...boxes, ...branch.groups.flatMap(({ key }) => places.groups.get(key) ?? [])];
}

const snapped = (length: number): number => GRID * Math.round(length / GRID);

// The innermost open group at a point.
export function groupAt(at: Point, { tree, places }: Pick<Scene, "tree" | "places">): string {
  return innermost(at, tree.root, places, (group) => !group.folded);
}

// The innermost group at a point, open or folded, into which groups can be dropped: none of them, and none
// inside them.
export function dropGroupAt(
  at: Point,
  { tree, places }: Pick<Scene, "tree" | "places">,
  dropped: string[],
): string {
  return innermost(at, tree.root, places, (group) => !dropped.includes(group.key));
}

function innermost(at: Point, branch: Branch, places: Places, takes: (group: Branch) => boolean): string {
  const found = branch.groups.find((group) => takes(group) && holds(places.groups.get(group.key), at));
  if (found === undefined) {
    return branch.key;
  }
  return found.folded ? found.key : innermost(at, found, places, takes);
}

function holds(rect: Rect | undefined, { x, y }: Point): boolean {
  return (
    rect !== undefined && x >= rect.x && x <= rect.x + rect.width && y >= rect.y && y <= rect.y + rect.height
  );
}
