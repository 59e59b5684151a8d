// The comments that the layout of a document holds; anything else in it is passed over.

import type { Rect } from "../layout/rects";

export type CanvasComment = Rect & { id: string; text: string };

const SIZE = { width: 200, height: 72 };

export function readComments(layout: Record<string, unknown>): CanvasComment[] {
  const given = layout["comments"];
  if (typeof given !== "object" || given === null) {
    return [];
  }
  return Object.entries(given as Record<string, unknown>).flatMap(([id, comment]) => {
    const { text, x, y, width, height } = (comment ?? {}) as Record<string, unknown>;
    if (typeof text !== "string" || !isNumber(x) || !isNumber(y)) {
      return [];
    }
    return [
      {
        id,
        text,
        x,
        y,
        width: isNumber(width) ? width : SIZE.width,
        height: isNumber(height) ? height : SIZE.height,
      },
    ];
  });
}

const isNumber = (value: unknown): value is number => typeof value === "number" && Number.isFinite(value);
