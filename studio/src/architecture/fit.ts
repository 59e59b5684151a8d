// How the whole architecture is shown on the canvas.

import type { FitViewOptions } from "@xyflow/react";

// The left margin keeps clear of the buttons.
export const MARGIN = { top: 32, right: 48, bottom: 32, left: 64 };
export const ZOOM = { min: 0.03, max: 2.5, whole: 1.15 };

export const FIT: FitViewOptions = {
  padding: {
    top: `${MARGIN.top}px`,
    right: `${MARGIN.right}px`,
    bottom: `${MARGIN.bottom}px`,
    left: `${MARGIN.left}px`,
  },
  maxZoom: ZOOM.whole,
};
