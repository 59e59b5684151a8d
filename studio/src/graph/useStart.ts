// What the canvas shows until a person moves the view: the whole architecture, at any size of the panel, with
// groups folded so that names can be read.

import { getViewportForBounds, useReactFlow } from "@xyflow/react";
import { type RefObject, useCallback, useEffect, useLayoutEffect, useMemo, useRef, useState } from "react";
import type { Kind } from "../protocol";
import { FIT, ZOOM } from "./layout/fit";
import { firstFolded, useOpening, withFolded } from "./layout/folding";
import { PANEL, type Rect } from "./layout/layout";
import { scene, type GraphScene, type Structure } from "./scene";

// A panel that differs by less keeps its layout.
const DIFFERENT = 24;

type Start = {
  now: GraphScene;
  // To call when a person moves or changes something.
  touch: () => void;
};

export function useStart(
  structure: Structure,
  kinds: Map<string, Kind>,
  around: RefObject<HTMLElement | null>,
): Start {
  const { setViewport } = useReactFlow();
  const { folded, panel } = useOpening();
  // The first element of an empty document stays where it was put.
  const touched = useRef(structure.elements.length === 0);
  const [times, setTimes] = useState(0);
  const latest = useRef({ structure, kinds });
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
      if (touched.current || width === 0 || height === 0) {
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
  }, [around]);

  const now = useMemo(
    () => scene(withFolded(structure, folded), kinds, panel),
    [structure, folded, kinds, panel],
  );

  // Again where only the size of the panel changed, which `times` counts.
  useEffect(() => {
    const size = around.current?.getBoundingClientRect();
    if (!touched.current && size !== undefined && size.width > 0 && now.nodes.length > 0) {
      const { width, height } = size;
      void setViewport(
        getViewportForBounds(wholeOf(now), width, height, ZOOM.min, ZOOM.whole, FIT.padding ?? 0),
      );
    }
  }, [now, times, around, setViewport]);

  const touch = useCallback(() => {
    touched.current = true;
  }, []);
  return { now, touch };
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
