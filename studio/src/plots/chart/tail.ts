// A trajectory as a line that fades into the past, with a dot at its end.

import type uPlot from "uplot";
import type { Look } from "../colors/look";
import type { Trajectory } from "../kinds/trajectory";

// Parts of the line, each more opaque than the one before.
const PARTS = 32;
const FAINTEST = 0.08;
const WIDTH = 1.75;
const DOT = 4;

// `level`: where a dashed line runs across, such as at the rate 0, on which fixed points lie.
export function drawTail(
  chart: uPlot,
  { across, up }: Trajectory,
  level: number | null,
  color: string,
  look: Look,
): void {
  const { ctx, bbox } = chart;
  const scale = look.unit * devicePixelRatio;
  const x = (i: number) => chart.valToPos(across[i] as number, "x", true);
  const y = (i: number) => chart.valToPos(up[i] as number, "y", true);
  const last = across.length - 1;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  if (level !== null) {
    const height = Math.round(chart.valToPos(level, "y", true));
    ctx.strokeStyle = look.dim;
    ctx.lineWidth = scale;
    ctx.setLineDash([5 * scale, 4 * scale]);
    ctx.beginPath();
    ctx.moveTo(bbox.left, height);
    ctx.lineTo(bbox.left + bbox.width, height);
    ctx.stroke();
    ctx.setLineDash([]);
  }
  ctx.strokeStyle = color;
  ctx.fillStyle = color;
  ctx.lineWidth = WIDTH * scale;
  ctx.lineJoin = "round";
  for (let part = 0; part < PARTS; part++) {
    const [from, to] = [Math.floor((part * last) / PARTS), Math.floor(((part + 1) * last) / PARTS)];
    if (to > from) {
      ctx.globalAlpha = FAINTEST + (1 - FAINTEST) * ((part + 1) / PARTS) ** 2;
      ctx.beginPath();
      ctx.moveTo(x(from), y(from));
      for (let i = from + 1; i <= to; i++) {
        ctx.lineTo(x(i), y(i));
      }
      ctx.stroke();
    }
  }
  ctx.globalAlpha = 1;
  if (last >= 0) {
    ctx.beginPath();
    ctx.arc(x(last), y(last), DOT * scale, 0, 2 * Math.PI);
    ctx.fill();
  }
  ctx.restore();
}
