// Boxes glide to where another layout of the document has them: after an insertion, Tidy and undo, and where
// another page moves them. A browser transition would leave the live pictures behind.

import { type RefObject, useCallback, useLayoutEffect, useRef } from "react";
import type { Structure } from "../architecture/contract";
import { glide } from "./glide";
import type { SceneNode } from "../architecture/nodes";
import type { GraphScene } from "../architecture/scene";

const MOVE_MS = 160;
// In px; a box that was dragged is nearer to its place in whole pixels.
const LEAST = 2;

// Gives what ends the movement at once, with the nodes then; null: nothing moves.
export function useGlide(
  scene: GraphScene,
  layout: Structure["layout"],
  shown: RefObject<{ nodes: SceneNode[] }>,
  show: (nodes: SceneNode[]) => void,
): () => SceneNode[] | null {
  const last = useRef({ scene, layout });
  const frame = useRef(0);
  useLayoutEffect(() => {
    const before = last.current;
    last.current = { scene, layout };
    const starts = new Map(shown.current.nodes.map((node) => [node.id, node]));
    const ms = glide(MOVE_MS);
    if (ms === 0 || before.layout === layout || foldedIn(before.scene) !== foldedIn(scene)) {
      return;
    }
    const ways = new Map(
      scene.nodes.flatMap(({ id, parentId, position: { x, y } }) => {
        const from = starts.get(id);
        const [dx, dy] = [(from?.position.x ?? x) - x, (from?.position.y ?? y) - y];
        return from?.parentId !== parentId || Math.hypot(dx, dy) < LEAST ? [] : [[id, { dx, dy }] as const];
      }),
    );
    if (ways.size === 0) {
      return;
    }
    const begun = performance.now();
    const step = () => {
      const part = Math.min(1, (performance.now() - begun) / ms);
      show(
        part === 1 ? scene.nodes : scene.nodes.map((node) => onWay(node, ways.get(node.id), (1 - part) ** 3)),
      );
      frame.current = part === 1 ? 0 : requestAnimationFrame(step);
    };
    step();
    return () => cancelAnimationFrame(frame.current);
  }, [scene, layout, shown, show]);
  return useCallback(() => {
    const isMoving = frame.current !== 0;
    cancelAnimationFrame(frame.current);
    frame.current = 0;
    return isMoving ? last.current.scene.nodes : null;
  }, []);
}

// A node at a part of its way before its place.
function onWay(node: SceneNode, way: { dx: number; dy: number } | undefined, part: number): SceneNode {
  const { x, y } = node.position;
  return way === undefined ? node : { ...node, position: { x: x + part * way.dx, y: y + part * way.dy } };
}

// A group that is folded stays under the pointer, and what is around it moves at once.
const foldedIn = ({ tree }: GraphScene): string =>
  [...tree.groups.values()].flatMap(({ key, folded }) => (folded ? [key] : [])).join(" ");
