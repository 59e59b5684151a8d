// Between places in the world and pixels of a canvas: y points upwards, both axes have the same scale.

import type { SceneView } from "../protocol";

export type PlanPoint = { x: number; y: number };
export type SceneObject = {
  name: string;
  fixed: boolean;
  x: number;
  y: number;
  width: number;
  height: number;
};

export type PlanFrame = {
  // pixels in a unit of the world
  scale: number;
  // where the lower left corner of the world lies
  left: number;
  bottom: number;
  border: [number, number, number, number];
};

const MARGIN = { left: 46, right: 14, top: 12, bottom: 36 };
// The distance in pixels at which a pointer picks a mark.
const NEAR = 9;

export function frameOf(border: number[], width: number, height: number): PlanFrame {
  const [x0, y0, x1, y1] = border as [number, number, number, number];
  const room = {
    x: Math.max(1, width - MARGIN.left - MARGIN.right),
    y: Math.max(1, height - MARGIN.top - MARGIN.bottom),
  };
  const scale = Math.min(room.x / (x1 - x0), room.y / (y1 - y0));
  const left = MARGIN.left + (room.x - scale * (x1 - x0)) / 2;
  const bottom = MARGIN.top + (room.y + scale * (y1 - y0)) / 2;
  return { scale, left, bottom, border: [x0, y0, x1, y1] };
}

export function toPixels({ scale, left, bottom, border }: PlanFrame, { x, y }: PlanPoint): PlanPoint {
  return { x: left + scale * (x - border[0]), y: bottom - scale * (y - border[1]) };
}

export function toWorld({ scale, left, bottom, border }: PlanFrame, { x, y }: PlanPoint): PlanPoint {
  return { x: border[0] + (x - left) / scale, y: border[1] + (bottom - y) / scale };
}

// The nearest place inside the border.
export function within(border: number[], { x, y }: PlanPoint): PlanPoint {
  const [x0, y0, x1, y1] = border as [number, number, number, number];
  return { x: Math.min(x1, Math.max(x0, x)), y: Math.min(y1, Math.max(y0, y)) };
}

export function inside({ border }: PlanFrame, place: PlanPoint): PlanPoint {
  return within(border, place);
}

// Objects that can be picked, marks first: they lie above solid objects.
export function objects({ boxes, marks }: SceneView): SceneObject[] {
  return [...marks.map((mark) => ({ ...mark, width: 0, height: 0 })), ...[...boxes].reverse()];
}

// What lies under a pointer.
export function under(scene: SceneView, frame: PlanFrame, pixel: PlanPoint): SceneObject | null {
  const { x, y } = toWorld(frame, pixel);
  const holds = (object: SceneObject) => {
    if (object.width === 0) {
      const at = toPixels(frame, object);
      return Math.hypot(at.x - pixel.x, at.y - pixel.y) <= NEAR;
    }
    return Math.abs(x - object.x) <= object.width / 2 && Math.abs(y - object.y) <= object.height / 2;
  };
  return objects(scene).find(holds) ?? null;
}

// Steps of an axis: 1, 2 or 5 times a power of ten, none nearer than `least` pixels.
export function ticks(
  lower: number,
  upper: number,
  scale: number,
  least: number,
): { values: number[]; digits: number } {
  const wanted = least / scale;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const step = power * ([1, 2, 5, 10].find((n) => n * power >= wanted * (1 - 1e-9)) ?? 10);
  const values: number[] = [];
  for (let n = Math.ceil(lower / step - 1e-9); n * step <= upper + 1e-9 * step; n++) {
    values.push(n * step + 0);
  }
  return { values, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

// A place as text, to a thousandth of the longer side.
export function placeText({ x, y }: PlanPoint, border: number[], unit: string): string {
  const longest = Math.max(
    (border[2] as number) - (border[0] as number),
    (border[3] as number) - (border[1] as number),
  );
  const digits = Math.max(0, 3 - Math.ceil(Math.log10(longest)));
  return `${x.toFixed(digits)}, ${y.toFixed(digits)} ${unit}`.trim();
}

// An unused name for a new object.
export function freeName({ boxes, marks }: SceneView): string {
  const taken = new Set([...boxes, ...marks].map(({ name }) => name));
  for (let n = 1; ; n++) {
    if (!taken.has(`box ${n}`)) {
      return `box ${n}`;
    }
  }
}
