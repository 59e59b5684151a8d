// Changes of the layout, as messages to the server.

import type { Answer } from "../protocol";
import { request } from "../socket";
import { useStudio } from "../store";
import { readFolded } from "./boxes";
import type { Point } from "./layout";

// Fold a group, or open it. The document keeps it, without a step of undo.
export function fold(key: string, closed: boolean): void {
  const folded = readFolded(useStudio.getState().document?.layout ?? {}).filter((other) => other !== key);
  void request({ type: "arrange", layout: { folded: closed ? [...folded, key] : folded }, undoable: false });
}

// Open several groups at once.
export function unfold(keys: string[]): void {
  const folded = readFolded(useStudio.getState().document?.layout ?? {}).filter((key) => !keys.includes(key));
  void request({ type: "arrange", layout: { folded }, undoable: false });
}

// Sets the positions of boxes, as one step of undo.
export function place(boxes: Map<string, Point>): Promise<Answer> {
  const rounded = [...boxes].map(([id, { x, y }]) => [id, { x: Math.round(x), y: Math.round(y) }]);
  return request({ type: "arrange", layout: { boxes: Object.fromEntries(rounded) }, undoable: true });
}
