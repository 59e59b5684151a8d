// A plot as a PNG: drawn again at twice its size in the colours of paper, with its title and legend.

import uPlot from "uplot";
import { font, type Look, paperLook } from "./look";
import { saveFile } from "./save";
import type { ChartOptions } from "./useChart";

export type LegendEntry = { label: string; color: string };

export type Shot = {
  title: string;
  width: number;
  height: number;
  options: (look: Look) => ChartOptions;
  data: uPlot.AlignedData;
  legend?: (look: Look) => LegendEntry[];
  // Lies under the axes and fills their inside.
  image?: HTMLCanvasElement;
};

const FACTOR = 2;
const HEAD = 26;
const LINE = 20;
const MARGIN = 10;
const SWATCH = 14;

export async function exportPng(shot: Shot): Promise<void> {
  // uPlot multiplies by the device's pixels itself.
  const look = paperLook(FACTOR / devicePixelRatio);
  const size = { width: Math.round(shot.width * look.unit), height: Math.round(shot.height * look.unit) };
  const chart = new uPlot({ ...shot.options(look), ...size }, shot.data, document.createElement("div"));
  await new Promise((drawn) => setTimeout(drawn));
  const legend = placed(shot.legend?.(look) ?? [], shot.width);
  const lines = legend.reduce((most, { line }) => Math.max(most, line + 1), 0);
  const canvas = sheet(shot.width, shot.height + HEAD + LINE * lines, shot.title);
  const ctx = canvas.getContext("2d");
  if (ctx !== null) {
    const top = canvas.height - chart.ctx.canvas.height;
    if (shot.image !== undefined) {
      const { left, top: inner, width, height } = chart.bbox;
      ctx.imageSmoothingEnabled = false;
      ctx.drawImage(shot.image, left, top + inner, width, height);
    }
    ctx.drawImage(chart.ctx.canvas, 0, top);
    drawLegend(ctx, legend);
  }
  chart.destroy();
  save(canvas, shot.title);
}

// A picture has no axes: its samples become squares.
export function exportPicture(title: string, image: HTMLCanvasElement): void {
  const square = Math.max(1, Math.floor(640 / Math.max(image.width, image.height)));
  const canvas = sheet(
    (image.width * square) / FACTOR + 16,
    (image.height * square) / FACTOR + HEAD + 8,
    title,
  );
  const ctx = canvas.getContext("2d");
  if (ctx !== null) {
    ctx.imageSmoothingEnabled = false;
    ctx.drawImage(image, 8 * FACTOR, HEAD * FACTOR, image.width * square, image.height * square);
  }
  save(canvas, title);
}

function sheet(width: number, height: number, title: string): HTMLCanvasElement {
  const look = paperLook(FACTOR);
  const canvas = document.createElement("canvas");
  canvas.width = Math.round(width * FACTOR);
  canvas.height = Math.round(height * FACTOR);
  const ctx = canvas.getContext("2d");
  if (ctx !== null) {
    ctx.fillStyle = look.ground;
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    ctx.fillStyle = look.text;
    ctx.font = `600 ${font(look, 13)}`;
    ctx.textBaseline = "middle";
    ctx.fillText(title, MARGIN * FACTOR, (HEAD / 2) * FACTOR, canvas.width - 2 * MARGIN * FACTOR);
  }
  return canvas;
}

// The positions of the entries of a legend, in lines no longer than the sheet.
function placed(entries: LegendEntry[], width: number): { entry: LegendEntry; x: number; line: number }[] {
  const ctx = document.createElement("canvas").getContext("2d");
  if (ctx === null) {
    return [];
  }
  ctx.font = font(paperLook(1));
  let x = MARGIN;
  let line = 0;
  return entries.map((entry) => {
    const length = ctx.measureText(entry.label).width + SWATCH + 4;
    if (x > MARGIN && x + length > width - MARGIN) {
      x = MARGIN;
      line++;
    }
    const place = { entry, x, line };
    x += length + 16;
    return place;
  });
}

function drawLegend(ctx: CanvasRenderingContext2D, places: ReturnType<typeof placed>): void {
  const look = paperLook(FACTOR);
  ctx.font = font(look);
  ctx.textBaseline = "middle";
  for (const { entry, x, line } of places) {
    const y = (HEAD + (line + 0.5) * LINE) * FACTOR;
    ctx.fillStyle = entry.color;
    ctx.fillRect(x * FACTOR, y - FACTOR, SWATCH * FACTOR, 2 * FACTOR);
    ctx.fillStyle = look.text;
    ctx.fillText(entry.label, (x + SWATCH + 4) * FACTOR, y);
  }
}

function save(canvas: HTMLCanvasElement, title: string): void {
  canvas.toBlob((blob) => blob !== null && saveFile(blob, title, "png"), "image/png");
}
