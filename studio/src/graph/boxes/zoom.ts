// What the canvas shows at a zoom factor. Names keep a readable size on the screen: where they would become
// too small they grow against the zoom, and where a box has no room for its name it is a dot.

import { create } from "zustand";

// dot: a dot; title: name and live picture; full: everything.
export type DetailLevel = "dot" | "title" | "full";

// The smallest text of a full box is 11 px, that on a screen at least 10.
export const FULL = 10 / 11;
// A box is then about 30 px wide.
export const TITLE = 0.2;
// Edges are then long enough for the numbers of couplings.
export const NUMBERS = 0.42;
// Text on the screen has between this size and that of the next step, in px.
const TEXT = 11.2;
const STEPS = 8;

// A box with a curve then has room for two lines of its name.
export const LINES = 0.27;

export type CanvasLook = { level: DetailLevel; text: number; numbers: boolean; lines: boolean };

export function lookAt(zoom: number): CanvasLook {
  // A zoom that differs from a step by rounding alone belongs to that step.
  const step = 2 ** (Math.floor(STEPS * Math.log2(zoom) + 1e-6) / STEPS);
  return {
    level: zoom >= FULL ? "full" : zoom >= TITLE ? "title" : "dot",
    text: TEXT / step,
    numbers: zoom >= NUMBERS,
    lines: zoom >= LINES,
  };
}

// The look of the canvas now.
export const useLook = create<CanvasLook>(() => lookAt(1));

// The boxes that were in view when the canvas rested last. Others show their name alone: ports and live
// pictures of hundreds of boxes would interrupt a movement that brings them into view.
export const useInView = create<{ ids: ReadonlySet<string> }>(() => ({ ids: new Set() }));
