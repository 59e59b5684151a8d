// Where a new box is put: at the pointer, at the end of a wire, or beside what is selected.

import { BOX, LIVE } from "../graph/boxes/boxes";
import type { Places, Point, Rect } from "../graph/layout/layout";
import { type Branch, keyOf, type Tree } from "../graph/layout/tree";
import type { DocumentView } from "../protocol";

export const NEW_BOX = { width: BOX.width, height: BOX.title + LIVE.curve + BOX.pad };
const GAP = { side: 72, apart: 24 };
// The pointer is at the name of a new box.
const HEAD = BOX.title / 2;

// A position on the canvas, and the key of the group around it.
export type Placing = { at: Point; group: string };

type Scene = { tree: Tree; places: Places };

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
export function under(at: Point, scene: Scene): Placing {
  return rounded({ x: at.x - NEW_BOX.width / 2, y: at.y - HEAD }, groupAt(at, scene));
}

// A box whose inputs (`right`) or outputs are at the end of a wire.
export function atEnd(at: Point, right: boolean, scene: Scene): Placing {
  const x = right ? at.x : at.x - NEW_BOX.width;
  return rounded({ x, y: at.y - NEW_BOX.height / 2 }, groupAt(at, scene));
}

// A free place at the right or left of a box.
export function beside(element: string, right: boolean, scene: Scene): Placing {
  const at = scene.places.elements.get(element) ?? { x: 0, y: 0 };
  const x = right ? at.x + NEW_BOX.width + GAP.side : at.x - NEW_BOX.width - GAP.side;
  return rounded(free({ x, y: at.y }, scene), scene.tree.home.get(element) ?? "");
}

// A free place near a point of the canvas, such as its middle.
export function near(at: Point, scene: Scene): Placing {
  return rounded(free({ x: at.x - NEW_BOX.width / 2, y: at.y - NEW_BOX.height / 2 }, scene), "");
}

// The same place, or the next one below it without boxes.
function free(at: Point, { places, tree }: Scene): Point {
  const shown = new Set([...tree.groups.values()].flatMap((group) => group.elements));
  const boxes: Rect[] = [...places.elements]
    .filter(([id]) => shown.has(id))
    .map(([, box]) => ({ ...box, ...NEW_BOX }));
  let y = at.y;
  for (let hit = blocking(boxes, at.x, y); hit !== undefined; hit = blocking(boxes, at.x, y)) {
    y = hit.y + hit.height + GAP.apart;
  }
  return { x: at.x, y };
}

function blocking(boxes: Rect[], x: number, y: number): Rect | undefined {
  return boxes.find(
    (box) =>
      Math.abs(box.x - x) < NEW_BOX.width + GAP.apart / 2 &&
      Math.abs(box.y - y) < NEW_BOX.height + GAP.apart / 2,
  );
}

// The innermost open group at a point.
export function groupAt(at: Point, { tree, places }: Scene): string {
  return innermost(at, tree.root, places, (group) => !group.folded);
}

// The innermost group at a point, open or folded, into which groups can be dropped: none of them, and none
// inside them.
export function dropGroupAt(at: Point, { tree, places }: Scene, dropped: string[]): string {
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

function rounded({ x, y }: Point, group: string): Placing {
  return { at: { x: Math.round(x), y: Math.round(y) }, group };
}
