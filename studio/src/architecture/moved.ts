// Positions of boxes after something was dragged: everything shown keeps its position, so that
// nothing else moves.

import type { Places } from "./layout";
import type { Point } from "../model/rects";
import { groupNode } from "./scene";
import type { SceneNode } from "./nodes";
import { below, type Tree } from "./tree";

// The boxes of all elements, from the present nodes; elements of a folded group move with it.
export function moved(nodes: SceneNode[], found: Tree, places: Places): Map<string, Point> {
  const known = new Map(nodes.map((node) => [node.id, node]));
  const at = (node: SceneNode): Point => {
    const parent = known.get(node.parentId ?? "");
    const base = parent === undefined ? { x: 0, y: 0 } : at(parent);
    return { x: base.x + node.position.x, y: base.y + node.position.y };
  };
  const boxes = new Map<string, Point>();
  for (const node of nodes) {
    if (node.type === "box") {
      boxes.set(node.id, at(node));
    }
  }
  for (const group of found.groups.values()) {
    const node = known.get(groupNode(group.key));
    const before = places.groups.get(group.key);
    if (node?.type !== "folded" || before === undefined) {
      continue;
    }
    const now = at(node);
    for (const id of below(group)) {
      const inside = places.elements.get(id);
      if (inside !== undefined) {
        boxes.set(id, { x: inside.x + now.x - before.x, y: inside.y + now.y - before.y });
      }
    }
  }
  return boxes;
}

// Whether any box has another position than before (in stored pixels).
export function differ(boxes: Map<string, Point>, places: Places): boolean {
  return [...boxes].some(([id, { x, y }]) => {
    const before = places.elements.get(id);
    return (
      before === undefined || Math.round(before.x) !== Math.round(x) || Math.round(before.y) !== Math.round(y)
    );
  });
}
