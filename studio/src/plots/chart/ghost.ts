// The outline of the injected input: the Gaussian above one axis, its one- and two-sigma lines over two axes,
// a frame for a homogeneous input.

import type uPlot from "uplot";
import type { Injection } from "../spot";

export function paintGhost(
  canvas: HTMLCanvasElement,
  chart: uPlot,
  how: Injection,
  place: number[] | null,
  color: string,
): void {
  const { clientWidth: width, clientHeight: height } = chart.over;
  canvas.width = width * devicePixelRatio;
  canvas.height = height * devicePixelRatio;
  const ctx = canvas.getContext("2d");
  if (ctx === null) {
    return;
  }
  canvas.toggleAttribute("data-on", true);
  ctx.scale(devicePixelRatio, devicePixelRatio);
  ctx.strokeStyle = color;
  ctx.fillStyle = color;
  ctx.lineWidth = 1.5;
  ctx.setLineDash([4, 3]);
  if (place === null) {
    ctx.strokeRect(1.5, 1.5, width - 3, height - 3);
  } else if (how.shown.length === 1) {
    hill(ctx, chart, how, place[0] ?? 0, width, height);
  } else {
    rings(ctx, chart, how, place);
  }
}

// The shape only, half as high as the plot: its amplitude rarely fits the scale. Downwards where it inhibits.
function hill(
  ctx: CanvasRenderingContext2D,
  chart: uPlot,
  { shown, width: share, amplitude }: Injection,
  center: number,
  width: number,
  height: number,
): void {
  const range = (shown[0]?.upper ?? 1) - (shown[0]?.lower ?? 0);
  const periodic = shown[0]?.periodic ?? false;
  const foot = amplitude < 0 ? 1 : height - 1;
  const rise = ((amplitude < 0 ? 1 : -1) * height) / 2;
  ctx.beginPath();
  for (let x = 0; x <= width; x += 2) {
    let distance = Math.abs(chart.posToVal(x, "x") - center) / range;
    if (periodic && distance > 0.5) {
      distance = 1 - distance;
    }
    ctx.lineTo(x, foot + rise * Math.exp((-distance * distance) / (2 * share * share)));
  }
  ctx.stroke();
  ctx.globalAlpha = 0.12;
  ctx.lineTo(width, foot);
  ctx.lineTo(0, foot);
  ctx.fill();
}

function rings(
  ctx: CanvasRenderingContext2D,
  chart: uPlot,
  { shown, width: share }: Injection,
  place: number[],
): void {
  const [across, up] = shown;
  if (across === undefined || up === undefined) {
    return;
  }
  const x = chart.valToPos(place[0] ?? 0, "x");
  const y = chart.valToPos(place[1] ?? 0, "y");
  const reachX = share * chart.over.clientWidth;
  const reachY = share * chart.over.clientHeight;
  // Both white and black are needed on a map of all colours.
  for (const [line, color] of [
    [3.5, "#000000"],
    [1.5, "#ffffff"],
  ] as const) {
    ctx.lineWidth = line;
    ctx.strokeStyle = color;
    ctx.setLineDash([]);
    for (const times of [1, 2]) {
      ctx.globalAlpha = times === 1 ? 0.9 : 0.45;
      ctx.beginPath();
      ctx.ellipse(x, y, times * reachX, times * reachY, 0, 0, 2 * Math.PI);
      ctx.stroke();
    }
  }
}
