// A colour bar at the right of a chart, with numbers and a mark where the colours turn.

import type uPlot from "uplot";
import { font, type Look } from "./look";
import type { MapColors } from "./mapColors";
import { tick, ticks } from "../range";

const GAP = 12;
const WIDTH = 12;
const TICK = 4;

export function drawColorBar(
  chart: Pick<uPlot, "ctx" | "bbox">,
  look: Look,
  { table, range, middle: mark }: MapColors,
): void {
  if (look.small) {
    return;
  }
  const { ctx, bbox } = chart;
  const unit = look.unit * devicePixelRatio;
  const left = bbox.left + bbox.width + GAP * unit;
  const width = WIDTH * unit;
  const place = (value: number) => bbox.top + bbox.height * (1 - (value - range[0]) / (range[1] - range[0]));
  ctx.save();
  for (let i = 0; i < 256; i++) {
    const bottom = bbox.top + bbox.height * (1 - i / 256);
    const height = bbox.height / 256 + unit;
    ctx.fillStyle = `rgb(${table[4 * i]} ${table[4 * i + 1]} ${table[4 * i + 2]})`;
    ctx.fillRect(left, Math.max(bbox.top, bottom - height), width, height);
  }
  ctx.strokeStyle = look.dim;
  ctx.fillStyle = look.dim;
  ctx.lineWidth = unit;
  ctx.strokeRect(left, bbox.top, width, bbox.height);
  ctx.font = font({ ...look, unit });
  ctx.textAlign = "left";
  ctx.textBaseline = "middle";
  const { places, step } = ticks(range, bbox.height / (36 * unit));
  for (const value of places) {
    const y = Math.round(place(value));
    ctx.beginPath();
    ctx.moveTo(left + width, y);
    ctx.lineTo(left + width + TICK * unit, y);
    ctx.stroke();
    ctx.fillText(tick(value, step), left + width + (TICK + 3) * unit, y);
  }
  if (mark !== null && mark > range[0] && mark < range[1]) {
    ctx.lineWidth = 1.5 * unit;
    ctx.strokeStyle = "#333333";
    ctx.beginPath();
    ctx.moveTo(left, place(mark));
    ctx.lineTo(left + width, place(mark));
    ctx.stroke();
  }
  ctx.restore();
}
