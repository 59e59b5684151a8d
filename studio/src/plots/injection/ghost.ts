// The outline of the injected input: the Gaussian above one axis, its one- and two-sigma lines over two axes,
// a frame for a homogeneous input.

import type { Injection } from "./spot";

// Both black and white are needed on a map of all colours.
const ON_MAP = [
  [3.5, "#000000"],
  [1.5, "#ffffff"],
] as const;

// Where values are on the page: pixels from the corner of what lies over a drawing.
export type ValuePlane = Readonly<{
  over: HTMLElement;
  valuesAt: (pixels: readonly [number, number]) => [number, number];
  placeOf: (values: readonly [number, number]) => [number, number];
}>;

type GhostSheet = { ctx: CanvasRenderingContext2D; drawing: ValuePlane; width: number; height: number };

export function paintGhost(
  canvas: HTMLCanvasElement,
  drawing: ValuePlane,
  how: Injection,
  place: number[] | null,
  color: string,
): void {
  const { clientWidth: width, clientHeight: height } = drawing.over;
  canvas.width = width * devicePixelRatio;
  canvas.height = height * devicePixelRatio;
  const ctx = canvas.getContext("2d");
  if (ctx === null) {
    return;
  }
  canvas.toggleAttribute("data-on", true);
  ctx.scale(devicePixelRatio, devicePixelRatio);
  const sheet = { ctx, drawing, width, height };
  const pens = how.shown.length === 1 ? ([[1.5, color]] as const) : ON_MAP;
  for (const [line, stroke] of pens) {
    ctx.lineWidth = line;
    ctx.strokeStyle = stroke;
    ctx.fillStyle = stroke;
    if (place === null) {
      ctx.strokeRect(2, 2, width - 4, height - 4);
    } else if (how.shown.length === 1) {
      hill(sheet, how, place[0] ?? 0);
    } else {
      rings(sheet, how, place);
    }
  }
}

// The shape only, half as high as the plot: its amplitude rarely fits the scale. Downwards where it inhibits.
function hill(
  { ctx, drawing, width, height }: GhostSheet,
  { shown, width: share, amplitude }: Injection,
  center: number,
): void {
  const range = (shown[0]?.upper ?? 1) - (shown[0]?.lower ?? 0);
  const periodic = shown[0]?.periodic ?? false;
  const foot = amplitude < 0 ? 1 : height - 1;
  const rise = ((amplitude < 0 ? 1 : -1) * height) / 2;
  ctx.setLineDash([5, 4]);
  ctx.beginPath();
  for (let x = 0; x <= width; x += 2) {
    let distance = Math.abs(drawing.valuesAt([x, 0])[0] - center) / range;
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
  { ctx, drawing, width, height }: GhostSheet,
  { width: share }: Injection,
  place: number[],
): void {
  const [x, y] = drawing.placeOf([place[0] ?? 0, place[1] ?? 0]);
  for (const times of [1, 2]) {
    ctx.globalAlpha = times === 1 ? 0.9 : 0.45;
    ctx.beginPath();
    ctx.ellipse(x, y, times * share * width, times * share * height, 0, 0, 2 * Math.PI);
    ctx.stroke();
  }
}
