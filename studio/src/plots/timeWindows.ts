// The time windows in which a stimulus is on, over time.

import type uPlot from "uplot";

import { type Values, valueAt } from "../values";
import type { Look } from "./colors/look";

const SHADE = 0.12;

export function timeWindows(values: Values): [number, number][] {
  const windows = values["windows"];
  return (Array.isArray(windows) ? windows : []).flatMap((window: unknown) => {
    const [start, stop] = [valueAt(window, "start"), valueAt(window, "stop")];
    return typeof start === "number" && typeof stop === "number" ? [[start, stop]] : [];
  });
}

export function drawWindows(chart: uPlot, windows: [number, number][], look: Look): void {
  const { ctx, bbox } = chart;
  ctx.save();
  ctx.fillStyle = look.text;
  ctx.globalAlpha = SHADE;
  for (const [start, stop] of windows) {
    const left = Math.max(bbox.left, chart.valToPos(start, "x", true));
    const right = Math.min(bbox.left + bbox.width, chart.valToPos(stop, "x", true));
    if (right > left) {
      ctx.fillRect(left, bbox.top, right - left, bbox.height);
    }
  }
  ctx.restore();
}
