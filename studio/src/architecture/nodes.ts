// What the canvas shows: boxes, frames, folded groups, comments and wires, as xyflow takes them.

import type { PinView } from "../protocol";
import type { Edge, Node } from "@xyflow/react";
import type { WireContent } from "./contract";
import type { Rect } from "../model/rects";
import type { Chain } from "./chains";
import type { Sign } from "./sign";
import type { Course } from "./wirePath";

export type BoxData = {
  element: string;
  path: string;
  name: string;
  title: string;
  kind: string;
  dimensions: number | null;
  inputs: string[];
  outputs: string[];
  // The elements of a contracted architecture that are drawn in the box.
  dots: string[];
  badges: string[];
  // Those with a slider in the box.
  pins: PinView[];
};
// A port of an element in a folded group that is connected with the outside.
export type FoldedPort = { element: string; port: string; path: string };
// `inputs` and `outputs` are those of a folded group, up to `MOST_PORTS`.
export type GroupData = {
  key: string;
  name: string;
  count: number;
  inputs: FoldedPort[];
  outputs: FoldedPort[];
};
// `chains`: what a wire stands for; those of a folded group are one. `shared`: whether an arrow ends at the
// same port. `room`: the width of what is drawn on the wire. `course`: null until all are led.
export type WireData = {
  pills: string[];
  reads: string;
  sign: Sign;
  shared: boolean;
  count: number;
  room: number;
  course: Course | null;
  chains: Chain[];
  content: WireContent | null;
  revealed: string[];
};

export type BoxNode = Node<BoxData, "box">;
export type FrameNode = Node<GroupData, "frame">;
export type FoldedNode = Node<GroupData, "folded">;
export type CommentNode = Node<{ comment: string; text: string }, "comment">;
export type SceneNode = BoxNode | FrameNode | FoldedNode | CommentNode;
export type Wire = Edge<WireData, "wire">;

// Positions on the canvas; those of nodes in an open group are relative to it.
export function rectsOf(nodes: SceneNode[]): Map<string, Rect> {
  const found = new Map<string, Rect>();
  for (const { id, parentId, position, width = 0, height = 0 } of nodes) {
    const parent = found.get(parentId ?? "");
    found.set(id, {
      x: position.x + (parent?.x ?? 0),
      y: position.y + (parent?.y ?? 0),
      width,
      height,
    });
  }
  return found;
}
