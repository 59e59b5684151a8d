// A colour bar at the right of a drawing, with numbers and a mark where the colours turn.

import type { Area } from "./axes";
import type { MapColors } from "./content";
import { font, type Ink, strokeLines } from "./ink";
import { ticks } from "./scale";
import { tick } from "./text";

const GAP = 12;
const WIDTH = 12;
const TICK = 4;
const APART = 36;

export function drawColorBar(
  ctx: CanvasRenderingContext2D,
  box: Area,
  ink: Ink,
  { tables, range, middle }: MapColors,
): void {
  if (ink.small) {
    return;
  }
  const { unit } = ink;
  const table = tables[ink.shade];
  const left = box.left + box.width + GAP * unit;
  const width = WIDTH * unit;
  const place = (value: number) => box.top + box.height * (1 - (value - range[0]) / (range[1] - range[0]));
  ctx.save();
  for (let i = 0; i < 256; i++) {
    const bottom = box.top + box.height * (1 - i / 256);
    const height = box.height / 256 + unit;
    ctx.fillStyle = `rgb(${table[4 * i]} ${table[4 * i + 1]} ${table[4 * i + 2]})`;
    ctx.fillRect(left, Math.max(box.top, bottom - height), width, height);
  }
  ctx.strokeStyle = ink.dim;
  ctx.fillStyle = ink.dim;
  ctx.lineWidth = unit;
  ctx.strokeRect(left, box.top, width, box.height);
  ctx.font = font(ink);
  ctx.textAlign = "left";
  ctx.textBaseline = "middle";
  const { places, step } = ticks(range, box.height / (APART * unit));
  for (const value of places) {
    const y = Math.round(place(value));
    strokeLines(ctx, [left + width, y, left + width + TICK * unit, y]);
    ctx.fillText(tick(value, step), left + width + (TICK + 3) * unit, y);
  }
  if (middle !== null && middle > range[0] && middle < range[1]) {
    ctx.lineWidth = 1.5 * unit;
    ctx.strokeStyle = "#333333";
    strokeLines(ctx, [left, place(middle), left + width, place(middle)]);
  }
  ctx.restore();
}
