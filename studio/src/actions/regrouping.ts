// What is dragged into a group, or out of it, moves there when it is released: the pointer decides, and the
// group below it is marked.

import { positionsOf } from "./arrange";
import { boxSize } from "../architecture/boxes";
import { boxPins } from "../state/pin";
import { FRAME } from "../architecture/layout";
import type { Point } from "../model/rects";
import { type GraphScene, groupKey } from "../architecture/scene";
import type { SceneNode } from "../architecture/nodes";
import { below, type Branch } from "../architecture/tree";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { isEditable } from "../state/editable";
import { usePicked } from "./picked";
import { dropGroupAt, pathOf } from "./placing";
import { getStage, pointerOf } from "./stage";

const APART = 24;

// Mark the group that takes what is dragged, if it is another one than that of the node below the pointer.
export function markGroup(event: MouseEvent | TouchEvent, grabbed: SceneNode, dragged: SceneNode[]): void {
  const [stage, at] = [getStage(), pointerOf(event)];
  const { over, into } = usePicked.getState();
  let found: string | null = null;
  // a copy (Alt) and an element that is inserted into a connection stay in their groups
  if (stage !== null && at !== undefined && isEditable() && !event.altKey && over === null) {
    const scene = stage.scene();
    const home = homeOf(grabbed, scene);
    const there = dropGroupAt(stage.toFlow({ x: at.clientX, y: at.clientY }), scene, groupsOf(dragged));
    found = home === null || home === there ? null : there;
  }
  if (found !== into) {
    usePicked.setState({ into: found });
  }
}

// Move what was dragged into the group that is marked; `boxes` are the positions of all boxes. Null: none is.
export function dropIntoGroup(dragged: SceneNode[], boxes: Map<string, Point>): Promise<boolean> | null {
  const { into } = usePicked.getState();
  const { document } = useStudio.getState();
  const scene = getStage()?.scene();
  usePicked.setState({ into: null });
  if (into === null || document === null || scene === undefined) {
    return null;
  }
  const groups = groupsOf(dragged);
  const elements = dragged.filter(({ id, type }) => type === "box" && !isWithin(scene, id, groups));
  const target = scene.tree.groups.get(into);
  if (target?.folded === true) {
    const inside = groups.flatMap((key) => below(scene.tree.groups.get(key) as Branch));
    putBelow(target, [...elements.map(({ id }) => id), ...inside], boxes, scene);
  }
  return request({
    type: "move_into",
    elements: elements.map(({ id }) => id),
    groups: groups.map((key) => pathOf(key, document)),
    group: pathOf(into, document),
    positions: positionsOf(boxes),
  }).then(({ problems = [] }) => problems.length === 0);
}

const groupsOf = (dragged: SceneNode[]): string[] =>
  dragged.filter(({ type }) => type === "frame" || type === "folded").map(({ id }) => groupKey(id));

// The group around a node; null for a comment, which is in none.
function homeOf({ id, type }: SceneNode, { tree }: GraphScene): string | null {
  return (
    (type === "box" ? tree.home.get(id) : type === "comment" ? null : tree.outer.get(groupKey(id))) ?? null
  );
}

function isWithin({ tree }: GraphScene, element: string, groups: string[]): boolean {
  const home = `${tree.home.get(element) ?? ""}/`;
  return groups.some((key) => home.startsWith(`${key}/`));
}

// Boxes that disappear in a folded group lie below the others there when it is opened.
function putBelow(target: Branch, ids: string[], boxes: Map<string, Point>, { places }: GraphScene): void {
  const { elements, document } = useStudio.getState();
  const held = below(target).flatMap((id) => {
    const [at, element] = [places.elements.get(id), elements.get(id)];
    const pins = boxPins(document?.layout, id).length;
    return at === undefined || element === undefined
      ? []
      : [{ x: at.x, y: at.y + boxSize(element, pins).height }];
  });
  const moved = ids.flatMap((id) => boxes.get(id) ?? []);
  const rect = places.groups.get(target.key) ?? { x: 0, y: 0 };
  const left = held.length > 0 ? Math.min(...held.map(({ x }) => x)) : rect.x + FRAME.side;
  const top = held.length > 0 ? Math.max(...held.map(({ y }) => y)) + APART + FRAME.top : rect.y + FRAME.top;
  const [dx, dy] = [left - Math.min(...moved.map(({ x }) => x)), top - Math.min(...moved.map(({ y }) => y))];
  for (const id of ids) {
    const at = boxes.get(id);
    if (at !== undefined) {
      boxes.set(id, { x: at.x + dx, y: at.y + dy });
    }
  }
}
