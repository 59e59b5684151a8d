// Levels as dashed lines across a chart, each with its name and value above it, or below where there would be
// no room.

import type uPlot from "uplot";
import { FIELD_COLORS } from "../colors/colors";
import type { Level } from "./levels";
import { font, type Look } from "../colors/look";
import { short } from "../range";

const LABEL = 13;

export function drawLevels(chart: uPlot, levels: Level[], look: Look): void {
  const { ctx, bbox } = chart;
  const scale = look.unit * devicePixelRatio;
  const taken: number[] = [];
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.strokeStyle = FIELD_COLORS[look.shade].level;
  ctx.fillStyle = FIELD_COLORS[look.shade].level;
  ctx.lineWidth = scale;
  ctx.setLineDash([5 * scale, 4 * scale]);
  ctx.font = font({ ...look, unit: scale }, 10.5);
  ctx.textAlign = "left";
  ctx.textBaseline = "middle";
  for (const { label, value } of levels) {
    const y = Math.round(chart.valToPos(value, "left", true));
    ctx.beginPath();
    ctx.moveTo(bbox.left, y);
    ctx.lineTo(bbox.left + bbox.width, y);
    ctx.stroke();
    if (look.small) {
      continue;
    }
    const above = y - (LABEL / 2) * scale;
    const below = y + (LABEL / 2) * scale;
    const free = (place: number) =>
      place > bbox.top + (LABEL / 2) * scale &&
      taken.every((other) => Math.abs(other - place) >= LABEL * scale);
    const place = free(above) ? above : below;
    taken.push(place);
    ctx.fillText(`${label} ${short(value)}`, bbox.left + 6 * scale, place);
  }
  ctx.restore();
}
