// The canvas on the screen, for what adds to it: the canvas passes on its interface when it is shown.

import type { Point } from "../model/rects";
import type { GraphScene } from "../architecture/scene";

export type Stage = {
  around: HTMLElement;
  toFlow: (at: Point) => Point;
  toScreen: (at: Point) => Point;
  scene: () => GraphScene;
  // Brings an element into view, with the same zoom.
  reveal: (element: string) => void;
  // Selects an element and brings it into the middle.
  center: (element: string) => void;
  // Selects a group with all its elements and brings it into view.
  centerGroup: (group: string) => void;
  // Shows the whole architecture, and again when the size of the canvas changes.
  showAll: () => void;
  // Gives all boxes new places, as one step of undo.
  tidy: () => void;
};

let stage: Stage | null = null;
let pointer: Point | null = null;

if (typeof addEventListener === "function") {
  const follow = ({ clientX, clientY }: PointerEvent) => {
    pointer = { x: clientX, y: clientY };
  };
  addEventListener("pointermove", follow, { capture: true, passive: true });
}

// Null while another view hides the canvas.
export const getStage = (): Stage | null => (stage?.around.checkVisibility() === true ? stage : null);

export function setStage(made: Stage | null): void {
  stage = made;
}

// The position of the pointer on the screen where the canvas is below it, else null.
export function getPointer(): Point | null {
  const over = pointer === null ? null : document.elementFromPoint(pointer.x, pointer.y);
  return over !== null && stage?.around.contains(over) === true ? pointer : null;
}

// The middle of the canvas.
export function middleOf({ around, toFlow }: Stage): Point {
  const { left, top, width, height } = around.getBoundingClientRect();
  return toFlow({ x: left + width / 2, y: top + height / 2 });
}

// An element, group or comment as it is drawn; of an element without a box, its mark on another one.
export function drawnNode(node: string): Element | null {
  const id = CSS.escape(node);
  const selector = `.react-flow__node[data-id="${id}"], [data-element="${id}"]`;
  return getStage()?.around.querySelector(selector) ?? null;
}

// The pointer or the finger of an event.
export const pointerOf = (event: MouseEvent | TouchEvent): MouseEvent | Touch | undefined =>
  "clientX" in event ? event : event.changedTouches[0];

// Whether keys are meant for the canvas: it has the focus, or nothing has.
export function isOnCanvas(focus: Element | null): boolean {
  const around = getStage()?.around;
  return around !== undefined && (focus === null || around.contains(focus) || focus.contains(around));
}
