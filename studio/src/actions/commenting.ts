// Comments on the canvas: they are part of the layout, and no part of the model.

import type { Point } from "../model/rects";
import type { Answer } from "../protocol";
import { request } from "../server/socket";
import { pageStore } from "../state/pageStore";
import { isEditable } from "../state/editable";
import { getPointer, getStage, middleOf } from "./stage";

// The comment that was added just now, whose text is edited at once.
export const useNewComment = pageStore<{ comment: string }>(() => ({ comment: "" }));

type Change = { text?: string; at?: [number, number]; size?: [number, number] };

export async function addComment(at: Point | null = getPointer()): Promise<void> {
  const stage = getStage();
  if (!isEditable() || stage === null) {
    return;
  }
  const place = at === null ? middleOf(stage) : stage.toFlow(at);
  const position = [Math.round(place.x), Math.round(place.y)];
  const { made = [] } = await request({ type: "comment", text: "Comment", at: position });
  useNewComment.setState({ comment: made[0] ?? "" });
}

export function changeComment(comment: string, change: Change): Promise<Answer> {
  return request({ type: "comment", comment, ...change });
}

export const removeComment = (comment: string): Promise<Answer> =>
  request({ type: "comment", comment, remove: true });
