// What surrounds a scene: the box with ticks and names of its axes, and the colour bar. It is drawn below the
// scene, so the edges in front of it are left out.

import type { AxisView } from "../../protocol";
import { drawColorBar } from "../../draw/bar";
import { font, type Ink, strokeLines } from "../../draw/ink";
import type { MapColors } from "../../draw/content";
import { ticks } from "../../draw/scale";
import { tick } from "../../draw/text";
import { cameraAt, type Point3, projection, type Viewpoint } from "../../model/sceneView";

export type SceneAxis = {
  label: string;
  range: readonly [number, number];
  // The axis of the model, for the linked cursor; missing: it carries values.
  along?: AxisView;
  // Whether the slice at a right angle to it shows the maximum over it, and so has no position.
  folded?: boolean;
};

export type SceneFrame = {
  // Lengths of the box.
  size: Point3;
  axes: readonly [SceneAxis, SceneAxis, SceneAxis];
  bar: MapColors | null;
};

const TICK = 5;
const NUMBER = 15;
const NAME = 31;
const BAR_TOP = 14;
const BAR_RIGHT = 66;
const SPACE = 44;

export function drawSceneFrame(
  ctx: CanvasRenderingContext2D,
  { size, axes, bar }: SceneFrame,
  view: Viewpoint,
  look: Ink,
  width: number,
  height: number,
): void {
  const { unit } = look;
  const place = projection(view, width, height);
  const at = (corner: Point3): [number, number] => {
    const [x, y] = place([corner[0] * size[0] * 0.5, corner[1] * size[1] * 0.5, corner[2] * size[2] * 0.5]);
    return [x * unit, y * unit];
  };
  const camera = cameraAt(view);
  const near = camera.map((value) => (value < 0 ? -1 : 1)) as unknown as Point3;
  ctx.save();
  ctx.lineWidth = unit;
  ctx.strokeStyle = look.dim;
  ctx.fillStyle = look.dim;
  ctx.font = font(look);
  ctx.textBaseline = "middle";
  ctx.textAlign = "center";
  for (const [from, to] of [0, 1, 2].flatMap(edgesOfBox)) {
    if (!equal(from, near) && !equal(to, near)) {
      strokeLines(ctx, [...at(from), ...at(to)]);
    }
  }
  axes.forEach((axis, d) => {
    const [from, to] = labelled(d, at);
    drawAxis(ctx, axis, [at(from), at(to)], at([0, 0, 0]), look);
  });
  ctx.restore();
  if (bar !== null) {
    const bbox = { left: 0, top: BAR_TOP * unit, width: (width - BAR_RIGHT) * unit, height: height * unit };
    bbox.height = Math.max(20, bbox.height - 2 * bbox.top);
    drawColorBar(ctx, bbox, look, bar);
  }
}

type Pixel = [number, number];

function drawAxis(
  ctx: CanvasRenderingContext2D,
  { label, range }: SceneAxis,
  [from, to]: readonly [Pixel, Pixel],
  middle: Pixel,
  { unit }: Ink,
): void {
  const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
  // At a right angle to the axis, away from the middle of the box.
  let out: Pixel = [(from[1] - to[1]) / (length || 1), (to[0] - from[0]) / (length || 1)];
  const centre: Pixel = [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2];
  if (out[0] * (centre[0] - middle[0]) + out[1] * (centre[1] - middle[1]) < 0) {
    out = [-out[0], -out[1]];
  }
  const beside = (point: Pixel, distance: number): Pixel => [
    point[0] + out[0] * distance * unit,
    point[1] + out[1] * distance * unit,
  ];
  // An axis that points at the camera has no room for numbers.
  if (length > SPACE * unit) {
    const { places, step } = ticks([range[0], range[1]], length / (SPACE * unit));
    for (const value of places) {
      const share = (value - range[0]) / (range[1] - range[0]);
      const point: Pixel = [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])];
      strokeLines(ctx, [...point, ...beside(point, TICK)]);
      ctx.fillText(tick(value, step), ...beside(point, NUMBER));
    }
  }
  ctx.fillText(label, ...beside(centre, NAME));
}

// The edge of the box along an axis that carries its numbers: of the first two axes the lower one on the
// screen, of the third one the leftmost.
function labelled(d: number, at: (corner: Point3) => Pixel): [Point3, Point3] {
  const rank = ([from, to]: [Point3, Point3]) =>
    d === 2 ? -at(from)[0] - at(to)[0] : at(from)[1] + at(to)[1];
  const edges = edgesOfBox(d).filter(([from]) => d === 2 || from[2] === -1);
  return edges.reduce((best, edge) => (rank(edge) > rank(best) ? edge : best));
}

const SIDES = [-1, 1] as const;

// The four edges along an axis.
function edgesOfBox(d: number): [Point3, Point3][] {
  return SIDES.flatMap((a) =>
    SIDES.map((b) => SIDES.map((end) => [a, b].toSpliced(d, 0, end)) as unknown as [Point3, Point3]),
  );
}

function equal(one: Point3, other: Point3): boolean {
  return one.every((value, d) => value === other[d]);
}
