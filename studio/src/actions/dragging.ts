// Boxes that are dragged with Alt: a copy is put where they were released, and they stay.

import type { SceneNode } from "../architecture/nodes";
import { copyTo, cornerOf } from "./clipboard";
import { useStudio } from "../server/store";
import { isEditable } from "../state/editable";
import { getStage } from "./stage";

export function copyDragged(nodes: SceneNode[]): void {
  const { selected } = useStudio.getState();
  const scene = getStage()?.scene();
  const corner = cornerOf(selected);
  const before = new Map(scene?.nodes.map((node) => [node.id, node.position]));
  const moved = nodes.find(({ id, position }) => {
    const was = before.get(id);
    return was !== undefined && (was.x !== position.x || was.y !== position.y);
  });
  const was = before.get(moved?.id ?? "");
  if (isEditable() && corner !== null && moved !== undefined && was !== undefined) {
    void copyTo({ x: corner.x + moved.position.x - was.x, y: corner.y + moved.position.y - was.y });
  }
}
