// Draws a world from above: floor, axes, objects, the paths of the bodies, marks, bodies.

import type { BodyView, BoxView, MarkView } from "../protocol";
import { drawAxes } from "../draw/axes";
import { type Ink, strokeLines } from "../draw/ink";
import type { Seen } from "../server/live";
import { type PlanFrame, type PlanPoint, sidesOf, toPixels } from "./planFrame";

const FLOOR = "#f5f5f0";
const INK = "#1c2420";
const GOAL = "#00734f";
const REFUSED = "#b3261e";
// Of several bodies; colours that most people can tell apart (Okabe and Ito).
const BODIES = ["#0050a0", "#b85c00", "#00734f", "#9b3a78"];

export type CarriedObject = { name: string; at: PlanPoint; refused: boolean };
export type Picked = { hovered: string | null; selected: string | null; held: CarriedObject | null };

export function draw(
  ctx: CanvasRenderingContext2D,
  frame: PlanFrame,
  { scene, bodies, path }: Seen,
  picked: Picked,
  look: Ink,
): void {
  if (scene === null) {
    return;
  }
  const { left, top, width, height } = frame.layout.box;
  drawAxes(ctx, sidesOf(scene.border, scene.unit), frame.layout, look, frame.width);
  ctx.strokeStyle = look.dim;
  ctx.strokeRect(left - 0.5, top - 0.5, width + 1, height + 1);
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, width, height);
  ctx.fillStyle = FLOOR;
  ctx.fill();
  ctx.clip();
  const held = picked.held;
  for (const box of scene.boxes) {
    drawBox(ctx, frame, box, box.name === picked.selected || box.name === picked.hovered);
  }
  bodies.forEach((_, n) => drawPath(ctx, frame, path, n, bodies[n] as BodyView));
  for (const mark of scene.marks) {
    drawMark(ctx, frame, mark, mark.name === picked.selected || mark.name === picked.hovered);
  }
  bodies.forEach((body, n) => drawBody(ctx, frame, body, BODIES[n % BODIES.length] as string));
  if (held?.refused === true) {
    const box = scene.boxes.find(({ name }) => name === held.name);
    drawGhost(ctx, frame, held.at, box);
  }
  ctx.restore();
}

function drawBox(ctx: CanvasRenderingContext2D, frame: PlanFrame, box: BoxView, marked: boolean): void {
  const corner = toPixels(frame, { x: box.x - box.width / 2, y: box.y + box.height / 2 });
  const [r, g, b] = box.color.map((part) => Math.round(255 * part));
  ctx.fillStyle = `rgb(${r} ${g} ${b})`;
  ctx.fillRect(corner.x, corner.y, box.width * frame.scale, box.height * frame.scale);
  if (marked && !box.fixed) {
    ctx.strokeStyle = INK;
    ctx.lineWidth = 2;
    ctx.strokeRect(corner.x - 1, corner.y - 1, box.width * frame.scale + 2, box.height * frame.scale + 2);
  }
}

function drawGhost(
  ctx: CanvasRenderingContext2D,
  frame: PlanFrame,
  at: PlanPoint,
  box: BoxView | undefined,
): void {
  const width = (box?.width ?? 0) * frame.scale || 16;
  const height = (box?.height ?? 0) * frame.scale || 16;
  const middle = toPixels(frame, at);
  ctx.strokeStyle = REFUSED;
  ctx.lineWidth = 2;
  ctx.setLineDash([4, 3]);
  ctx.strokeRect(middle.x - width / 2, middle.y - height / 2, width, height);
  ctx.setLineDash([]);
}

function drawPath(
  ctx: CanvasRenderingContext2D,
  frame: PlanFrame,
  path: number[][],
  n: number,
  body: BodyView,
): void {
  ctx.strokeStyle = BODIES[n % BODIES.length] as string;
  ctx.lineWidth = 1.5;
  ctx.lineJoin = "round";
  ctx.beginPath();
  for (const places of [
    ...path.map((row) => ({ x: row[2 * n] as number, y: row[2 * n + 1] as number })),
    body,
  ]) {
    const at = toPixels(frame, places);
    ctx.lineTo(at.x, at.y);
  }
  ctx.stroke();
}

function drawMark(ctx: CanvasRenderingContext2D, frame: PlanFrame, mark: MarkView, marked: boolean): void {
  const { x, y } = toPixels(frame, mark);
  const reach = marked ? 8 : 6;
  ctx.strokeStyle = GOAL;
  ctx.lineWidth = marked ? 3 : 2;
  strokeLines(ctx, [x - reach, y, x + reach, y]);
  strokeLines(ctx, [x, y - reach, x, y + reach]);
}

function drawBody(ctx: CanvasRenderingContext2D, frame: PlanFrame, body: BodyView, colour: string): void {
  const { x, y } = toPixels(frame, body);
  const radius = Math.max(3, body.radius * frame.scale);
  ctx.fillStyle = "#ffffff";
  ctx.strokeStyle = colour;
  ctx.lineWidth = 2;
  ctx.beginPath();
  ctx.arc(x, y, radius, 0, 2 * Math.PI);
  ctx.fill();
  ctx.stroke();
  strokeLines(ctx, [x, y, x + radius * Math.cos(body.heading), y - radius * Math.sin(body.heading)]);
}
