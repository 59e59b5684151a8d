// New elements are selected, and the new box has the focus, as soon as the document has them.

import { useStudio } from "../server/store";
import { drawnNode, getStage } from "./stage";

const PATIENCE_MS = 5000;
const FRAMES = 30;

export function showMade(made: string[]): void {
  if (made.length === 0) {
    return;
  }
  const shown = () => made.every((id) => useStudio.getState().elements.has(id));
  const show = () => {
    useStudio.getState().select(made);
    getStage()?.reveal(made[0] ?? "");
    focusBox(made[0] ?? "");
  };
  if (shown()) {
    show();
    return;
  }
  const leave = useStudio.subscribe(() => {
    if (shown()) {
      stop();
      show();
    }
  });
  const timer = setTimeout(() => stop(), PATIENCE_MS);
  const stop = () => {
    leave();
    clearTimeout(timer);
  };
}

// The box of an element receives the focus; a new one is drawn first.
export function focusBox(element: string, frames = FRAMES): void {
  const box = drawnNode(element);
  if (box instanceof HTMLElement) {
    box.focus({ preventScroll: true });
  } else if (frames > 0) {
    requestAnimationFrame(() => focusBox(element, frames - 1));
  }
}
