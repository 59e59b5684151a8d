// Changes of the layout, as messages to the server.

import type { Answer } from "../protocol";
import { request } from "../socket";
import { useStudio } from "../store";
import { foldedNow, useOpening } from "./folding";
import type { Point } from "./layout";

// Fold a group, or open it. The document keeps it, without a step of undo.
export function fold(key: string, closed: boolean): void {
  const others = now().filter((other) => other !== key);
  keep(closed ? [...others, key] : others);
}

// Open several groups at once.
export function unfold(keys: string[]): void {
  keep(now().filter((key) => !keys.includes(key)));
}

function now(): string[] {
  return foldedNow(useStudio.getState().document?.layout ?? {});
}

// At once on this page, also on one without a server, where no document keeps it.
function keep(folded: string[]): void {
  useOpening.setState({ folded });
  void request({ type: "arrange", layout: { folded }, undoable: false });
}

// Sets the positions of boxes, as one step of undo.
export function place(boxes: Map<string, Point>): Promise<Answer> {
  const rounded = [...boxes].map(([id, { x, y }]) => [id, { x: Math.round(x), y: Math.round(y) }]);
  return request({ type: "arrange", layout: { boxes: Object.fromEntries(rounded) }, undoable: true });
}
