// The line over time at the moment that the page shows.

import type uPlot from "uplot";

import type { Look } from "./look";

export function drawMoment(chart: uPlot, moment: number | null, look: Look): void {
  if (moment === null) {
    return;
  }
  const { ctx, bbox } = chart;
  const x = Math.round(chart.valToPos(moment, "x", true));
  if (x < bbox.left || x > bbox.left + bbox.width) {
    return;
  }
  ctx.save();
  ctx.strokeStyle = look.text;
  ctx.lineWidth = Math.max(1, look.unit * devicePixelRatio);
  ctx.setLineDash([5 * look.unit * devicePixelRatio, 3 * look.unit * devicePixelRatio]);
  ctx.beginPath();
  ctx.moveTo(x, bbox.top);
  ctx.lineTo(x, bbox.top + bbox.height);
  ctx.stroke();
  ctx.restore();
}
