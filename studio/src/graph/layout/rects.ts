// Rectangles of boxes.

export type Point = { x: number; y: number };
export type Size = { width: number; height: number };
export type Rect = Point & Size;

// Whether two rectangles cover a part of each other.
export function meet(a: Rect, b: Rect): boolean {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

// Boxes of one size at their places.
export function boxesOf(places: Map<string, Point>, size: Size): Map<string, Rect> {
  return new Map([...places].map(([id, place]) => [id, { ...place, ...size }] as const));
}

// The pairs that cover a part of each other.
export function overlaps(boxes: Map<string, Rect>): [string, string][] {
  const all = [...boxes];
  return all.flatMap(([id, box], i) =>
    all.slice(i + 1).flatMap(([other, rect]): [string, string][] => (meet(box, rect) ? [[id, other]] : [])),
  );
}
