// The nodes on the canvas: those of the scene, moved while they are dragged. The selection is
// the store's.

import { applyNodeChanges, useStoreApi, type NodeChange } from "@xyflow/react";
import { useCallback, useEffect, useMemo, useRef, useState } from "react";
import { changeComment } from "../actions/commenting";
import { useStudio } from "../server/store";
import type { Structure } from "../architecture/contract";
import { place } from "../actions/arrange";
import { differ, moved } from "../architecture/moved";
import { commentId, type GraphScene } from "../architecture/scene";
import type { SceneNode } from "../architecture/nodes";
import { useGlide } from "./useGlide";

// Steps by arrow keys that follow each other are one change.
const KEYS_MS = 500;

export function useNodes(scene: GraphScene, layout: Structure["layout"]) {
  const selected = useStudio((state) => state.selected);
  const [nodes, setNodes] = useState<SceneNode[]>(scene.nodes);
  const [seen, setSeen] = useState(scene);
  if (seen !== scene) {
    setSeen(scene);
    setNodes((before) => reconciled(before, scene.nodes));
  }
  const shown = useMemo(() => marked(nodes, new Set(selected)), [nodes, selected]);
  const latest = useRef({ nodes: shown, scene });
  const timer = useRef(0);
  const flow = useStoreApi();
  const show = useCallback((next: SceneNode[]) => setNodes((before) => reconciled(before, next)), []);
  const arrive = useGlide(scene, layout, latest, show);
  useEffect(() => {
    latest.current = { nodes: shown, scene };
  }, [shown, scene]);
  useEffect(() => () => window.clearTimeout(timer.current), [scene]);

  const settle = useCallback(() => {
    window.clearTimeout(timer.current);
    const { nodes: now, scene: of } = latest.current;
    moveComments(now, of.nodes);
    const boxes = moved(now, of.tree, of.places);
    if (differ(boxes, of.places)) {
      // If it was refused, all boxes return to their positions in the document.
      void place(boxes).then(
        ({ problems }) => (problems?.length ?? 0) > 0 && setNodes(latest.current.scene.nodes),
      );
    }
  }, []);

  const onNodesChange = useCallback(
    (changes: NodeChange<SceneNode>[]) => {
      choose(changes, latest.current.nodes, flow.getState().multiSelectionActive);
      const others = changes.filter((change) => change.type !== "select");
      if (others.length === 0) {
        return;
      }
      const isMove = others.some((change) => change.type === "position");
      const next = applyNodeChanges(others, (isMove ? arrive() : null) ?? latest.current.nodes);
      latest.current = { ...latest.current, nodes: next };
      setNodes(next);
      if (others.some((change) => change.type === "position" && change.dragging !== true)) {
        window.clearTimeout(timer.current);
        timer.current = window.setTimeout(settle, KEYS_MS);
      }
    },
    [settle, flow, arrive],
  );

  // Steps by arrow keys no longer become a change of their own: a drag takes them along. The last move of a
  // drag looks like such a step, and its change must not follow during the next drag.
  const forgetKeys = useCallback(() => window.clearTimeout(timer.current), []);

  // All boxes return to their positions in the document.
  const reset = useCallback(() => {
    window.clearTimeout(timer.current);
    setNodes(latest.current.scene.nodes);
  }, []);

  return { nodes: shown, onNodesChange, settle, forgetKeys, reset };
}

function moveComments(now: SceneNode[], before: SceneNode[]): void {
  const known = new Map(before.map((node) => [node.id, node.position]));
  for (const { id, type, position } of now) {
    const was = known.get(id);
    if (type === "comment" && was !== undefined && (was.x !== position.x || was.y !== position.y)) {
      void changeComment(commentId(id), { at: [Math.round(position.x), Math.round(position.y)] });
    }
  }
}

// The selection of xyflow becomes that of the store. Couplings on edges are not nodes: xyflow
// cannot take them out.
function choose(changes: NodeChange<SceneNode>[], nodes: SceneNode[], several: boolean): void {
  const choices = changes.filter((change) => change.type === "select");
  if (choices.length === 0) {
    return;
  }
  const { selected, select } = useStudio.getState();
  const next = new Set(several ? selected : selected.filter((id) => nodes.some((node) => node.id === id)));
  for (const { id, selected: chosen } of choices) {
    if (chosen) {
      next.add(id);
    } else {
      next.delete(id);
    }
  }
  if (next.size !== selected.length || selected.some((id) => !next.has(id))) {
    select([...next]);
  }
}

// A node that is the same stays the same object, so that React leaves it alone.
function reconciled(before: SceneNode[], next: SceneNode[]): SceneNode[] {
  const known = new Map(before.map((node) => [node.id, node]));
  return next.map((node) => {
    const old = known.get(node.id);
    if (old === undefined || old.type !== node.type) {
      return node;
    }
    const same = Object.entries(node).every(
      ([key, value]) => JSON.stringify(old[key as keyof SceneNode]) === JSON.stringify(value),
    );
    return same && old.parentId === node.parentId ? old : node;
  });
}

function marked(nodes: SceneNode[], selected: Set<string>): SceneNode[] {
  return nodes.map((node) =>
    (node.selected ?? false) === selected.has(node.id) ? node : { ...node, selected: selected.has(node.id) },
  );
}
