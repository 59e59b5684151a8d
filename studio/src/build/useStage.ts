// The canvas as the stage of building, and its pointer and keys: the palette opens at a double click, a right
// click and Tab; a kind that is dropped becomes an element.

import { useReactFlow } from "@xyflow/react";
import { type DragEvent, type MouseEvent, type RefObject, useEffect, useMemo, useRef } from "react";

import { glide } from "../graph/glide";
import type { GraphScene } from "../graph/scene";
import { useStudio } from "../store";
import { carried, isCarried } from "./carried";
import { addElement } from "./edits";
import { openPalette, spotFor } from "./palette";
import { getPointer, getStage, setStage } from "./stage";

const GLIDE_MS = 200;

export function useStage(around: RefObject<HTMLDivElement | null>, scene: GraphScene) {
  const flow = useReactFlow();
  const latest = useRef(scene);
  useEffect(() => {
    latest.current = scene;
  }, [scene]);

  useEffect(() => {
    const holder = around.current;
    if (holder === null) {
      return;
    }
    const reveal = (elements: string[]) => {
      const seen = holder.getBoundingClientRect();
      const hidden = elements.some((id) => {
        const at = latest.current.places.elements.get(id);
        const point = at === undefined ? null : flow.flowToScreenPosition(at);
        return point !== null && !isInside(point, seen);
      });
      if (hidden) {
        const nodes = elements.map((id) => ({ id }));
        void flow.fitView({ nodes, maxZoom: flow.getZoom(), duration: glide(GLIDE_MS), padding: 0.5 });
      }
    };
    setStage({
      around: holder,
      toFlow: (at) => flow.screenToFlowPosition(at),
      toScreen: (at) => flow.flowToScreenPosition(at),
      scene: () => latest.current,
      reveal: (elements) => requestAnimationFrame(() => reveal(elements)),
    });
    return () => setStage(null);
  }, [around, flow]);

  useTab();
  return useMemo(
    () => ({
      onDoubleClick: (event: MouseEvent) => isGround(event.target) && openPalette(place(event)),
      onDragOver: (event: DragEvent) => {
        if (isCarried(event.dataTransfer)) {
          event.preventDefault();
          event.dataTransfer.dropEffect = "copy";
        }
      },
      onDrop: (event: DragEvent) => {
        const kind = useStudio.getState().kinds.get(carried(event.dataTransfer));
        if (kind !== undefined) {
          event.preventDefault();
          void addElement(kind.name, spotFor(kind, place(event)));
        }
      },
    }),
    [],
  );
}

const place = ({ clientX, clientY }: MouseEvent) => ({ x: clientX, y: clientY });

function isInside({ x, y }: { x: number; y: number }, { left, top, right, bottom }: DOMRect): boolean {
  return x >= left && x < right - 40 && y >= top && y < bottom - 40;
}

// The empty ground of the canvas; frames let the pointer through.
export function isGround(target: EventTarget): boolean {
  return target instanceof Element && target.classList.contains("react-flow__pane");
}

// Tab opens the palette while the pointer is over the canvas and nothing in the canvas or beside it has the
// focus; otherwise it moves the focus.
function useTab(): void {
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      const plain = !event.shiftKey && !event.ctrlKey && !event.metaKey && !event.altKey;
      const focus = document.activeElement;
      const free = focus === null || focus.contains(getStage()?.around ?? null);
      if (event.key === "Tab" && plain && free && getPointer() !== null && !event.defaultPrevented) {
        event.preventDefault();
        openPalette();
      }
    };
    addEventListener("keydown", onKey);
    return () => removeEventListener("keydown", onKey);
  }, []);
}
