// Changes of the layout, as messages to the server.

import type { Moves } from "../../build/placing";
import type { Answer } from "../../protocol";
import { request } from "../../socket";
import { useStudio } from "../../store";
import { readBoxes } from "../boxes/boxes";
import { readComments } from "../boxes/comments";
import { everyElement } from "../contract";
import { foldedNow, useOpening } from "./folding";
import type { Point } from "./rects";

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
  return foldedNow(layoutNow());
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
  const stored = readBoxes(layoutNow());
  const boxes = [...stored].filter(([id]) => shown || !contracted.has(id));
  return request({
    type: "arrange",
    layout: { ...everyElement(shown), boxes: boxes.length === 0 ? null : Object.fromEntries(boxes) },
  });
}

// Sets the positions of boxes, as one step of undo.
export function place(boxes: Map<string, Point>): Promise<Answer> {
  return request({ type: "place", positions: movedTo(boxes, readBoxes(layoutNow())) });
}

// Positions of boxes and comments, as messages have them.
export function movesOf({ boxes, comments }: Moves): Record<"positions" | "comments", Positions> {
  const layout = layoutNow();
  const known = new Map(readComments(layout).map((comment) => [comment.id, comment]));
  return { positions: movedTo(boxes, readBoxes(layout)), comments: movedTo(comments, known) };
}

const layoutNow = () => useStudio.getState().document?.layout ?? {};

type Positions = Record<string, [number, number]>;

// Positions that the document has already are not sent: another page may change them meanwhile.
function movedTo(places: Map<string, Point>, stored: ReadonlyMap<string, Point>): Positions {
  const moved = Object.entries(positionsOf(places)).filter(
    ([id, [x, y]]) => stored.get(id)?.x !== x || stored.get(id)?.y !== y,
  );
  return Object.fromEntries(moved);
}

// Positions of boxes in whole pixels, as a message has them.
export function positionsOf(boxes: Map<string, Point>): Positions {
  return Object.fromEntries([...boxes].map(([id, { x, y }]) => [id, [Math.round(x), Math.round(y)]]));
}
