// A box without connections that is dropped on a connection is inserted into it.

import { boxSize } from "../architecture/boxes";
import { movesOf } from "./arrange";
import type { Point, Size } from "../model/rects";
import type { SceneNode } from "../architecture/nodes";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { isEditable } from "../state/editable";
import { boxPins } from "../state/pin";
import { usePicked } from "./picked";
import { onWire, type RoomyPlacing } from "./room";
import { getStage, pointerOf } from "./stage";
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
  if (over === null || wire === null) {
    return null;
  }
  const { document, elements, kinds } = useStudio.getState();
  const pins = boxPins(document?.layout, element).length;
  const [dropped, at] = [elements.get(element), boxes.get(element)];
  const room =
    dropped === undefined || at === undefined
      ? null
      : roomFor(over, at, boxSize(dropped, pins), kinds.get(dropped.kind)?.room, element);
  const moves = room?.moves ?? { boxes, comments: new Map() };
  if (room !== null) {
    moves.boxes.set(element, room.at);
  }
  return request({ type: "insert", element, wire, ...movesOf(moves) }).then(
    ({ problems = [] }) => problems.length === 0,
  );
}

// Where a box with its corner near a point is inserted into a connection, and what makes room for it. Null
// where nothing does: couplings lie on connections. `dragged`: the box, which stays in its group.
export function roomFor(
  wire: string | undefined,
  corner: Point,
  size: Size,
  room: string | undefined,
  dragged?: string,
): RoomyPlacing | null {
  const scene = getStage()?.scene();
  const drawn = scene?.wires.find(({ id }) => id === wire);
  if (scene === undefined || drawn === undefined || room === "couplings") {
    return null;
  }
  const found = onWire(drawn, corner, size, scene, dragged);
  return dragged !== undefined && found?.group !== scene.tree.home.get(dragged) ? null : found;
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
