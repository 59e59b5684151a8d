// The size of a document that is pasted, from its text.

import { FRAME } from "../architecture/layout";
import { boundsOf, type Point, type Size } from "../model/rects";
import type { Kind } from "../protocol";
import { sizeOfKind } from "./placing";

// `pad` is how far the frames of its groups reach beyond the first box.
export type Extent = { size: Size; pad: Point };

// Null: the text has no positions for all of its boxes, or has another format.
export function extentOf(text: string, kinds: Map<string, Kind>): Extent | null {
  try {
    return measured(parsed(text), kinds);
  } catch {
    return null; // parts of another type: the server says why
  }
}

function measured(read: Pasted | null, kinds: Map<string, Kind>): Extent | null {
  const boxes = read?.layout?.boxes ?? {};
  const rects = Object.values(read?.elements ?? {}).flatMap(({ id = "", kind = "" }) => {
    const at = boxes[id];
    return at === undefined ? [] : [{ ...at, ...sizeOfKind(kinds.get(kind)) }];
  });
  if (read === null || rects.length === 0 || rects.length < Object.keys(read.elements).length) {
    return null;
  }
  const { width, height } = boundsOf(rects);
  const depth = Math.max(0, ...(read.groups ?? []).map((path) => path.split(".").length));
  const size = { width: width + 2 * depth * FRAME.side, height: height + depth * (FRAME.top + FRAME.bottom) };
  const pad = { x: depth * FRAME.side, y: depth * FRAME.top };
  return Number.isFinite(size.width + size.height) ? { size, pad } : null;
}

type Pasted = {
  elements: Record<string, { id?: string; kind?: string }>;
  groups?: string[];
  layout?: { boxes?: Record<string, Point> };
};

function parsed(text: string): Pasted | null {
  try {
    const read = JSON.parse(text) as Partial<Pasted> | null;
    return typeof read?.elements === "object" ? (read as Pasted) : null;
  } catch {
    return null; // the server says why
  }
}
