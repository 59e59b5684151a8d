// What the canvas shows: the whole architecture at any size of the panel, until a person moves the view; then
// its middle stays in the middle. Until a person changes something, groups are folded so that names can be
// read.

import { getViewportForBounds, type Viewport, useReactFlow } from "@xyflow/react";
import { type RefObject, useCallback, useEffect, useLayoutEffect, useMemo, useRef, useState } from "react";
import type { Kind } from "../protocol";
import { useStudio } from "../server/store";
import { FIT, ZOOM } from "../architecture/fit";
import { firstFolded, useOpening, withFolded } from "../architecture/folding";
import { PANEL } from "../architecture/layout";
import type { Rect, Size } from "../model/rects";
import { scene, type GraphScene } from "../architecture/scene";
import type { Structure } from "../architecture/contract";

// A panel that differs by less keeps its layout.
const DIFFERENT = 24;

type Start = {
  now: GraphScene;
  // To call when a person moves or changes something.
  touch: () => void;
  // Shows everything.
  showAll: (duration?: number) => void;
};

// Around the selected box, in px.
const MARGIN = 12;

export function useStart(
  structure: Structure,
  kinds: Map<string, Kind>,
  around: RefObject<HTMLElement | null>,
): Start {
  const { setViewport, getViewport, getInternalNode } = useReactFlow();
  const { folded, panel } = useOpening();
  // The first element of an empty document stays where it was put.
  const touched = useRef(structure.elements.length === 0);
  const [times, setTimes] = useState(0);
  const latest = useRef({ structure, kinds });
  const shown = useRef<GraphScene | null>(null);
  // The view and the size of the panel when everything was shown last.
  const fitted = useRef<Viewport | null>(null);
  const size = useRef<Size | null>(null);

  const showAll = useCallback(
    (duration = 0) => {
      const { width = 0, height = 0 } = around.current?.getBoundingClientRect() ?? {};
      const scene = shown.current;
      if (width > 0 && scene !== null && scene.nodes.length > 0) {
        const whole = wholeOf(scene);
        fitted.current = getViewportForBounds(whole, width, height, ZOOM.min, ZOOM.whole, FIT.padding ?? 0);
        void setViewport(fitted.current, { duration });
      }
    },
    [around, setViewport],
  );

  // Another size of the panel.
  const resize = useCallback(
    (before: Size, now: Size) => {
      const view = getViewport();
      if (fitted.current !== null && isSame(view, fitted.current)) {
        showAll();
        return;
      }
      const moved = {
        ...view,
        x: view.x + (now.width - before.width) / 2,
        y: view.y + (now.height - before.height) / 2,
      };
      const node = getInternalNode(useStudio.getState().selected[0] ?? "");
      const { x, y } = node?.internals.positionAbsolute ?? { x: 0, y: 0 };
      const { width = 0, height = 0 } = node?.measured ?? {};
      void setViewport(
        node === undefined
          ? moved
          : {
              zoom: view.zoom,
              x: moved.x + inside(x * view.zoom + moved.x, width * view.zoom, now.width),
              y: moved.y + inside(y * view.zoom + moved.y, height * view.zoom, now.height),
            },
      );
    },
    [showAll, getViewport, getInternalNode, setViewport],
  );
  useLayoutEffect(() => {
    latest.current = { structure, kinds };
  }, [structure, kinds]);

  useLayoutEffect(() => {
    const element = around.current;
    if (element === null) {
      return;
    }
    const open = () => {
      const { width, height } = element.getBoundingClientRect();
      const known = width > 0 && height > 0 ? { width, height } : PANEL;
      useOpening.setState({
        panel: known,
        folded: firstFolded(latest.current.structure, latest.current.kinds, known),
      });
    };
    open();
    const observer = new ResizeObserver(() => {
      const { width, height } = element.getBoundingClientRect();
      if (width === 0 || height === 0) {
        return;
      }
      const last = size.current;
      size.current = { width, height };
      if (touched.current) {
        if (last !== null && (last.width !== width || last.height !== height)) {
          resize(last, size.current);
        }
        return;
      }
      const before = useOpening.getState().panel;
      if (Math.abs(before.width - width) > DIFFERENT || Math.abs(before.height - height) > DIFFERENT) {
        open();
      } else {
        setTimes((n) => n + 1);
      }
    });
    observer.observe(element);
    return () => observer.disconnect();
  }, [around, resize]);

  const now = useMemo(
    () => scene(withFolded(structure, folded), kinds, panel),
    [structure, folded, kinds, panel],
  );

  // Again where only the size of the panel changed, which `times` counts.
  useEffect(() => {
    shown.current = now;
    if (!touched.current) {
      showAll();
    }
  }, [now, times, showAll]);

  const touch = useCallback(() => {
    touched.current = true;
  }, []);
  return { now, touch, showAll };
}

const isSame = (a: Viewport, b: Viewport): boolean =>
  Math.abs(a.x - b.x) < 0.5 && Math.abs(a.y - b.y) < 0.5 && Math.abs(a.zoom - b.zoom) < 1e-3;

// How far a box on a line has to move to lie inside a panel.
function inside(start: number, length: number, panel: number): number {
  return Math.max(MARGIN - start, Math.min(0, panel - MARGIN - start - length));
}

// The rectangle around all nodes.
function wholeOf({ nodes }: GraphScene): Rect {
  const outer = nodes.filter((node) => node.parentId === undefined);
  const x = Math.min(...outer.map(({ position }) => position.x));
  const y = Math.min(...outer.map(({ position }) => position.y));
  return {
    x,
    y,
    width: Math.max(...outer.map(({ position, width }) => position.x + (width ?? 0))) - x,
    height: Math.max(...outer.map(({ position, height }) => position.y + (height ?? 0))) - y,
  };
}
