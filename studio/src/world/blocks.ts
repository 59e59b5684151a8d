// Coloured blocks that a click places in front of the robot: their names, their colours and where they fit.

import type { BodyView, BoxView, SceneView } from "../protocol";
import type { PlanPoint } from "./planFrame";

export type Swatch = { name: string; color: [number, number, number] };

// Saturated colours, a sixth of the hue circle apart.
export const SWATCHES: Swatch[] = [
  { name: "red", color: [0.85, 0.1, 0.1] },
  { name: "yellow", color: [0.9, 0.85, 0.1] },
  { name: "green", color: [0.1, 0.65, 0.15] },
  { name: "cyan", color: [0.1, 0.75, 0.8] },
  { name: "blue", color: [0.12, 0.25, 0.85] },
  { name: "magenta", color: [0.8, 0.15, 0.75] },
];

// The side of a block, in radii of the robot; and its distances from the rim of the robot, in sides: the
// first one that has room is taken. There a block fills the middle of the camera's picture, beyond the reach
// of most distance sensors.
const SIDE = 1.65;
const GAPS = [1.7, 1.2, 2.2, 0.8, 3, 4, 5, 0.5];
// Without a robot: as a share of the shorter side of the world.
const SHARE = 0.06;

export function blockName({ name }: Swatch): string {
  return `${name} block`;
}

export function cssColour([r, g, b]: number[]): string {
  return `rgb(${[r, g, b].map((part) => Math.round(255 * (part ?? 0))).join(" ")})`;
}

// The colour of a text like "#d01818".
export function colourOf(text: string): [number, number, number] {
  const part = (from: number) => Number.parseInt(text.slice(from, from + 2), 16) / 255;
  return [part(1), part(3), part(5)];
}

// The side of a block.
export function blockSide(scene: SceneView, body: BodyView | undefined): number {
  const [x0, y0, x1, y1] = scene.border as [number, number, number, number];
  return body === undefined ? SHARE * Math.min(x1 - x0, y1 - y0) : SIDE * body.radius;
}

// Where a block has room in front of a robot; null: nowhere. Without a robot in the middle of the world.
export function inFront(
  scene: SceneView,
  bodies: BodyView[],
  side: number,
  body: BodyView | undefined = bodies[0],
): PlanPoint | null {
  const [x0, y0, x1, y1] = scene.border as [number, number, number, number];
  const places =
    body === undefined
      ? [{ x: (x0 + x1) / 2, y: (y0 + y1) / 2 }]
      : GAPS.map((gap) => {
          const distance = body.radius + (gap + 0.5) * side;
          return {
            x: body.x + distance * Math.cos(body.heading),
            y: body.y + distance * Math.sin(body.heading),
          };
        });
  return places.find((place) => hasRoom(scene, bodies, place, side)) ?? null;
}

function hasRoom(
  { border, boxes, marks }: SceneView,
  bodies: BodyView[],
  { x, y }: PlanPoint,
  side: number,
): boolean {
  const half = side / 2;
  const [x0, y0, x1, y1] = border as [number, number, number, number];
  const clear = (box: BoxView) =>
    Math.abs(box.x - x) >= half + box.width / 2 || Math.abs(box.y - y) >= half + box.height / 2;
  const apart = (place: PlanPoint, radius: number) =>
    Math.hypot(Math.max(Math.abs(place.x - x) - half, 0), Math.max(Math.abs(place.y - y) - half, 0)) > radius;
  return (
    x - half >= x0 &&
    x + half <= x1 &&
    y - half >= y0 &&
    y + half <= y1 &&
    boxes.every(clear) &&
    marks.every((mark) => apart(mark, 0)) &&
    bodies.every((body) => apart(body, body.radius))
  );
}
