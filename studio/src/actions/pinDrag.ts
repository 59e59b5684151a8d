// A parameter of the inspector that is dragged to the sliders.

import type { DragEvent } from "react";

import { withPin } from "../state/pin";
import { keepPins } from "./pinning";

const TYPE = "application/x-deodar-parameter";

export function dragParameter({ dataTransfer }: DragEvent, element: string, parameter: string): void {
  dataTransfer.effectAllowed = "copy";
  dataTransfer.setData(TYPE, JSON.stringify([element, parameter]));
  dataTransfer.setData("text/plain", parameter);
}

// Where a parameter may be dropped, which pins it; `over`: while it is there.
export const dropParameter = (over?: () => void) => ({
  onDragOver: (event: DragEvent) => {
    if (event.dataTransfer.types.includes(TYPE)) {
      event.preventDefault();
      over?.();
    }
  },
  onDrop: (event: DragEvent) => {
    const data = event.dataTransfer.getData(TYPE);
    if (data !== "") {
      event.preventDefault();
      const [element, parameter] = JSON.parse(data) as [string, string];
      keepPins((pins) => withPin(pins, element, parameter));
    }
  },
});
