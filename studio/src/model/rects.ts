// Rectangles of boxes.

export type Point = { x: number; y: number };
export type Size = { width: number; height: number };
export type Rect = Point & Size;

// Whether two rectangles cover a part of each other.
export function meet(a: Rect, b: Rect): boolean {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

// The least rectangle that holds all.
export function boundsOf(rects: readonly (Point & Partial<Size>)[]): Rect {
  const [x, y] = [Math.min(...rects.map((rect) => rect.x)), Math.min(...rects.map((rect) => rect.y))];
  const right = Math.max(...rects.map((rect) => rect.x + (rect.width ?? 0)));
  const bottom = Math.max(...rects.map((rect) => rect.y + (rect.height ?? 0)));
  return { x, y, width: right - x, height: bottom - y };
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
