// What a hand does with an element that has no box of its own: a coupling on an edge, a dot or ring in a box.

import type { MouseEvent } from "react";
import { pickElement } from "./picked";
import { openPlot } from "./openPlot";

type Pressing = Readonly<Record<"onClick" | "onDoubleClick", (event: MouseEvent) => void>>;

export const pressing = (id: string): Pressing => ({
  onClick: (event) => {
    event.stopPropagation();
    pickElement(id, event.shiftKey || event.ctrlKey || event.metaKey);
  },
  onDoubleClick: (event) => {
    event.stopPropagation();
    openPlot({ element: id });
  },
});
