// The line over time at the moment that the page shows.

import type uPlot from "uplot";

import type { Look } from "../colors/look";

// `down`: time runs downwards, as the scale y.
export function drawMoment(chart: uPlot, moment: number | null, look: Look, down = false): void {
  if (moment === null) {
    return;
  }
  const { ctx, bbox } = chart;
  const at = Math.round(chart.valToPos(moment, down ? "y" : "x", true));
  const [first, size] = down ? [bbox.top, bbox.height] : [bbox.left, bbox.width];
  if (at < first || at > first + size) {
    return;
  }
  ctx.save();
  ctx.strokeStyle = look.text;
  ctx.lineWidth = Math.max(1, look.unit * devicePixelRatio);
  ctx.setLineDash([5 * look.unit * devicePixelRatio, 3 * look.unit * devicePixelRatio]);
  ctx.beginPath();
  ctx.moveTo(down ? bbox.left : at, down ? at : bbox.top);
  ctx.lineTo(down ? bbox.left + bbox.width : at, down ? at : bbox.top + bbox.height);
  ctx.stroke();
  ctx.restore();
}
