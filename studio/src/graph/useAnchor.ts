// A group that is folded or unfolded stays under the pointer, although the layout around it is a new one.

import { useReactFlow } from "@xyflow/react";
import { useLayoutEffect, useRef } from "react";
import type { Rect } from "../model/rects";
import type { GraphScene } from "../architecture/scene";

export function useAnchor(now: GraphScene): void {
  const { getViewport, setViewport } = useReactFlow();
  const last = useRef(now);
  useLayoutEffect(() => {
    const before = last.current;
    last.current = now;
    const changed = [...now.tree.groups.values()].filter(
      ({ key, folded }) => (before.tree.groups.get(key)?.folded ?? folded) !== folded,
    );
    const [from, to] = [before, now].map(({ places }) => places.groups.get(changed[0]?.key ?? ""));
    if (changed.length === 1 && from !== undefined && to !== undefined) {
      const { x, y, zoom } = getViewport();
      const step = shift(from, to);
      void setViewport({ x: x - zoom * step.x, y: y - zoom * step.y, zoom });
    }
  }, [now, getViewport, setViewport]);
}

function shift(from: Rect, to: Rect): { x: number; y: number } {
  return { x: to.x - from.x, y: to.y - from.y };
}
