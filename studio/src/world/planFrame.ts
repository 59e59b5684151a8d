// Between places in the world and pixels of a canvas: y points upwards, both axes have the same scale.

import { layout, type PlotLayout } from "../draw/axes";
import type { Content } from "../draw/content";
import { paperInk } from "../draw/ink";
import type { Range } from "../draw/scale";
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
  // of the canvas, in pixels of the page
  width: number;
  // pixels in a unit of the world
  scale: number;
  border: [number, number, number, number];
  layout: PlotLayout;
};

// The distance in pixels at which a pointer picks a mark.
const NEAR = 9;

// The sides of the plan: a plot without marks, which the world is drawn on.
export function sidesOf(border: number[], unit: string): Content {
  const [x0, y0, x1, y1] = border as [number, number, number, number];
  const side = (name: string, range: Range) => ({
    along: null,
    label: unit === "" ? name : `${name} (${unit})`,
    range,
  });
  return { x: side("x", [x0, x1]), y: side("y", [y0, y1]), equal: true, marks: [] };
}

export function frameOf(border: number[], width: number, height: number): PlanFrame {
  const [x0, y0, x1, y1] = border as [number, number, number, number];
  const placed = layout(sidesOf(border, ""), paperInk(1), width, height);
  return { width, scale: placed.box.width / (x1 - x0), border: [x0, y0, x1, y1], layout: placed };
}

export function toPixels({ layout: { x: across, y: up } }: PlanFrame, { x, y }: PlanPoint): PlanPoint {
  return { x: across.place(x), y: up.place(y) };
}

export function toWorld({ layout: { x: across, y: up } }: PlanFrame, { x, y }: PlanPoint): PlanPoint {
  return { x: across.value(x), y: up.value(y) };
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

// A place as text, to a thousandth of the longer side.
export function placeText({ x, y }: PlanPoint, border: number[], unit: string): string {
  const longest = Math.max(
    (border[2] as number) - (border[0] as number),
    (border[3] as number) - (border[1] as number),
  );
  const digits = Math.max(0, 3 - Math.ceil(Math.log10(longest)));
  return `${x.toFixed(digits)}, ${y.toFixed(digits)} ${unit}`.trim();
}

// An unused name for a new object of a sort.
export function freeName({ boxes, marks }: SceneView, sort = "box"): string {
  const taken = new Set([...boxes, ...marks].map(({ name }) => name));
  for (let n = 1; ; n++) {
    if (!taken.has(`${sort} ${n}`)) {
      return `${sort} ${n}`;
    }
  }
}
