// Empty bands across a layout are closed: a layout of edges with many bends leaves rows without any box.

import type { Point, Size } from "../model/rects";

// Moves boxes up, so that no row without a box is higher than `most`.
export function squeezed(
  places: Map<string, Point>,
  sizes: Map<string, Size>,
  most: number,
): Map<string, Point> {
  const all = [...places].sort(([, a], [, b]) => a.y - b.y);
  let bottom = all[0]?.[1].y ?? 0;
  let up = 0;
  return new Map(
    all.map(([id, { x, y }]) => {
      up += Math.max(0, y - bottom - most);
      bottom = Math.max(bottom, y + (sizes.get(id)?.height ?? 0));
      return [id, { x, y: y - up }];
    }),
  );
}
