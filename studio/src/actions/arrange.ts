// Changes of the layout, as messages to the server.

import type { Moves } from "./placing";
import type { Answer } from "../protocol";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { foldedNow, useOpening } from "../architecture/folding";
import type { Point } from "../model/rects";

// Fold a group, or open it. The document keeps it, without a step of undo.
export function fold(key: string, closed: boolean): void {
  const others = foldedNow().filter((other) => other !== key);
  keep(closed ? [...others, key] : others);
}

// Open several groups at once.
export function unfold(keys: string[]): void {
  keep(foldedNow().filter((key) => !keys.includes(key)));
}

// At once on this page, also on one without a server, where no document keeps it.
function keep(folded: string[]): void {
  useOpening.setState({ folded });
  void request({ type: "arrange", layout: { folded }, undoable: false });
}

// Without stored positions, a contracted architecture takes the shape of its canvas; one step of undo.
export function toGrid(): Promise<Answer> {
  return request({ type: "arrange", layout: { boxes: null } });
}

// Shows every element of a large architecture, or contracts them again. What a person has placed has its box;
// so that `contracted` elements lose theirs, their positions are forgotten.
export function showEvery(shown: boolean, contracted: ReadonlySet<string>): Promise<Answer> {
  const boxes = Object.entries(layoutNow().boxes).filter(([id]) => shown || !contracted.has(id));
  return request({
    type: "arrange",
    layout: {
      every_element: shown || null,
      boxes: boxes.length === 0 ? null : Object.fromEntries(boxes),
    },
  });
}

// Sets the positions of boxes, as one step of undo.
export function place(boxes: Map<string, Point>): Promise<Answer> {
  return request({ type: "place", positions: movedTo(boxes, layoutNow().boxes) });
}

// Positions of boxes and comments, as messages have them.
export function movesOf({ boxes, comments }: Moves): Record<"positions" | "comments", Positions> {
  const layout = layoutNow();
  return { positions: movedTo(boxes, layout.boxes), comments: movedTo(comments, layout.comments) };
}

type Positions = Record<string, [number, number]>;

// Positions that the document has already are not sent: another page may change them meanwhile.
function movedTo(places: Map<string, Point>, stored: Readonly<Record<string, Point>>): Positions {
  const moved = Object.entries(positionsOf(places)).filter(
    ([id, [x, y]]) => stored[id]?.x !== x || stored[id]?.y !== y,
  );
  return Object.fromEntries(moved);
}

const layoutNow = () => useStudio.getState().document?.layout ?? { boxes: {}, comments: {} };

// Positions of boxes in whole pixels, as a message has them.
export function positionsOf(boxes: Map<string, Point>): Positions {
  return Object.fromEntries([...boxes].map(([id, { x, y }]) => [id, [Math.round(x), Math.round(y)]]));
}
