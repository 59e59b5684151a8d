// The canvas as the stage of building, and its pointer and keys: the palette opens at a double click, a right
// click and Tab; a kind that is dropped becomes an element.

import { useReactFlow } from "@xyflow/react";
import { type DragEvent, type MouseEvent, type RefObject, useEffect, useMemo, useRef } from "react";

import { glide } from "./glide";
import type { Point } from "../model/rects";
import type { GraphScene } from "../architecture/scene";
import { useStudio } from "../server/store";
import { type Carried, carried, isCarried } from "../actions/carried";
import { listen } from "../actions/clipboard";
import { addElement, addTemplate } from "../actions/edits";
import { openPalette, passes, spotFor } from "../actions/palette";
import { usePicked } from "../actions/picked";
import { getPointer, getStage, setStage } from "../actions/stage";
import { NEW_BOX } from "../actions/placing";
import { firstOf, wireAt } from "../actions/wires";

const GLIDE_MS = 200;
const FRAMES = 30;

export function useStage(
  around: RefObject<HTMLDivElement | null>,
  scene: GraphScene,
  center: (element: string) => void,
  centerGroup: (group: string) => void,
  showAll: (duration: number) => void,
  tidy: () => void,
) {
  const flow = useReactFlow();
  const latest = useRef(scene);
  const acts = useRef({ center, centerGroup, showAll, tidy });
  useEffect(() => {
    latest.current = scene;
    acts.current = { center, centerGroup, showAll, tidy };
  }, [scene, center, centerGroup, showAll, tidy]);
  useEffect(listen, []);

  useEffect(() => {
    const holder = around.current;
    if (holder === null) {
      return;
    }
    // a new element reaches the scene a few frames later than the document
    const reveal = (element: string, frames = FRAMES) => {
      const at = latest.current.places.elements.get(element);
      if (at === undefined) {
        if (frames > 0) {
          requestAnimationFrame(() => reveal(element, frames - 1));
        }
        return;
      }
      const end = { x: at.x + NEW_BOX.width, y: at.y + NEW_BOX.height };
      const seen = holder.getBoundingClientRect();
      if (![at, end].every((point) => isInside(flow.flowToScreenPosition(point), seen))) {
        const duration = glide(GLIDE_MS);
        void flow.setCenter((at.x + end.x) / 2, (at.y + end.y) / 2, { zoom: flow.getZoom(), duration });
      }
    };
    setStage({
      around: holder,
      toFlow: (at) => flow.screenToFlowPosition(at),
      toScreen: (at) => flow.flowToScreenPosition(at),
      scene: () => latest.current,
      reveal,
      center: (element) => acts.current.center(element),
      centerGroup: (group) => acts.current.centerGroup(group),
      showAll: () => acts.current.showAll(glide(GLIDE_MS)),
      tidy: () => acts.current.tidy(),
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
          usePicked.setState({ over: wireAt(event.clientX, event.clientY) });
        }
      },
      onDragLeave: () => usePicked.setState({ over: null }),
      onDrop: (event: DragEvent) => {
        const dropped = carried(event.dataTransfer);
        const { over } = usePicked.getState();
        usePicked.setState({ over: null });
        if (dropped !== null) {
          event.preventDefault();
          drop(dropped, place(event), over);
        }
      },
    }),
    [],
  );
}

// Add what was dropped; a kind that is dropped on a connection is inserted into it.
function drop({ what, name, values, called }: Carried, at: Point, over: string | null): void {
  const kind = useStudio.getState().kinds.get(name);
  if (what === "template") {
    void addTemplate(name, spotFor(null, at));
  } else if (kind !== undefined) {
    const wire = over === null || !passes(kind) ? null : firstOf(over);
    const adding = wire === null ? { values, name: called } : { wire };
    void addElement(name, spotFor(kind, at, wire === null ? undefined : (over ?? undefined)), adding);
  }
}

const place = ({ clientX, clientY }: MouseEvent) => ({ x: clientX, y: clientY });

function isInside({ x, y }: { x: number; y: number }, { left, top, right, bottom }: DOMRect): boolean {
  return x >= left && x <= right && y >= top && y <= bottom;
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
