// A box without connections that is dropped on a connection is inserted into it.

import { positionsOf } from "../../graph/layout/arrange";
import type { Point } from "../../graph/layout/rects";
import type { SceneNode } from "../../graph/nodes";
import { request } from "../../socket";
import { useStudio } from "../../store";
import { isEditable } from "../editable";
import { usePicked } from "../picked";
import { pointerOf } from "../stage";
import { firstOf, wireAt } from "./wires";

// The connection below the pointer lights up while such a box is dragged over it.
export function markWire(event: MouseEvent | TouchEvent, dragged: SceneNode[]): void {
  const [node, ...others] = dragged;
  const at = pointerOf(event);
  const free = node !== undefined && others.length === 0 && isEditable() && isFree(node.id);
  const over = free && at !== undefined ? wireAt(at.clientX, at.clientY, node.id) : null;
  if (over !== usePicked.getState().over) {
    usePicked.setState({ over });
  }
}

// Insert a box into the connection that lights up; `boxes` are the positions of all boxes. Null: none does.
export function insertDropped(element: string, boxes: Map<string, Point>): Promise<boolean> | null {
  const { over } = usePicked.getState();
  usePicked.setState({ over: null });
  const wire = over === null ? null : firstOf(over);
  if (wire === null) {
    return null;
  }
  return request({ type: "insert", element, wire, positions: positionsOf(boxes) }).then(
    ({ problems = [] }) => problems.length === 0,
  );
}

function isFree(id: string): boolean {
  const { document, elements } = useStudio.getState();
  const element = elements.get(id);
  return (
    element !== undefined &&
    element.inputs.length > 0 &&
    element.outputs.length > 0 &&
    document?.connections.every(({ source, target }) => source !== id && target !== id) === true
  );
}
