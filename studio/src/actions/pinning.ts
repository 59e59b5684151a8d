// Pins a parameter, and stores changed pins with the document.

import { openTool } from "../state/tool";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import type { PinView } from "../protocol";
import { withPin } from "../state/pin";

// Pin a parameter as the last one, and show the sliders.
export function pin(element: string, parameter: string): void {
  keepPins((pins) => withPin(pins, element, parameter));
  openTool("pins");
}

// Keep them in the document, as one step of undo.
export function keepPins(change: (pins: PinView[]) => PinView[]): void {
  const pins = useStudio.getState().document?.layout.pins ?? [];
  const next = change(pins);
  if (next !== pins) {
    void request({ type: "arrange", layout: { pins: next }, undoable: true });
  }
}
