// Arrays onto canvases.

import { canvasSettings } from "./canvases";
import { type Shade, strokeLines } from "./ink";
import type { Range } from "./scale";

// 256 colours of 4 bytes (red, green, blue, opaque).
export type ColorTable = Uint8ClampedArray;

// The colours on a light and on a dark ground.
export type ColorTables = Readonly<Record<Shade, ColorTable>>;

export type Curve = {
  width: number;
  height: number;
  lower: number;
  upper: number;
  color: string;
  // The colour of what lies above 0.
  above?: string;
  // A line at 0, in this colour.
  zero?: string;
  lineWidth?: number;
};

// One image for each canvas, kept while its size stays: one putImageData for each frame is all that is paid.
type Surface = { ctx: CanvasRenderingContext2D; image: ImageData; words: Uint32Array };
const images = new WeakMap<HTMLCanvasElement, Surface>();
const words = new WeakMap<ColorTable, Uint32Array>();

// A heat map: one pixel for each sample, the canvas is stretched by its style. C order: index = ix * ny + iy;
// x to the right, y up or down. NaN is transparent.
export function paintHeat(
  canvas: HTMLCanvasElement,
  values: Float32Array,
  nx: number,
  ny: number,
  range: Range,
  scale: ColorTable,
  down = false,
): void {
  const target = imageOf(canvas, nx, ny);
  if (target === null) {
    return;
  }
  const colors = asWords(scale);
  const factor = range[1] > range[0] ? 255 / (range[1] - range[0]) : 0;
  for (let iy = 0; iy < ny; iy++) {
    const row = (down ? iy : ny - 1 - iy) * nx;
    for (let ix = 0, at = iy; ix < nx; ix++, at += ny) {
      const level = ((values[at] as number) - range[0]) * factor + 0.5;
      target.words[row + ix] = Number.isNaN(level)
        ? 0
        : (colors[level < 0 ? 0 : level > 255 ? 255 : level | 0] as number);
    }
  }
  target.ctx.putImageData(target.image, 0, 0);
}

// A picture: red, green and blue of each sample in `range`; index = (ix * ny + iy) * 3 + channel; x to the
// right, y up or down.
export function paintPicture(
  canvas: HTMLCanvasElement,
  values: Float32Array,
  nx: number,
  ny: number,
  range: Range = [0, 1],
  up = false,
): void {
  const target = imageOf(canvas, nx, ny);
  if (target === null) {
    return;
  }
  const bytes = target.image.data;
  const factor = range[1] > range[0] ? 255 / (range[1] - range[0]) : 0;
  for (let iy = 0; iy < ny; iy++) {
    const row = (up ? ny - 1 - iy : iy) * nx;
    for (let ix = 0; ix < nx; ix++) {
      const from = 3 * (ix * ny + iy);
      const to = 4 * (row + ix);
      bytes[to] = ((values[from] as number) - range[0]) * factor;
      bytes[to + 1] = ((values[from + 1] as number) - range[0]) * factor;
      bytes[to + 2] = ((values[from + 2] as number) - range[0]) * factor;
      bytes[to + 3] = 255;
    }
  }
  target.ctx.putImageData(target.image, 0, 0);
}

// A picture as the server sends it: a byte each for red, green and blue, row by row from the top. One of
// another size is not drawn.
export function paintBytes(
  canvas: HTMLCanvasElement,
  pixels: Uint8Array,
  columns: number,
  rows: number,
): void {
  const target = pixels.length === 3 * columns * rows ? imageOf(canvas, columns, rows) : null;
  if (target === null) {
    return;
  }
  const bytes = target.image.data;
  for (let from = 0, to = 0; from < pixels.length; from += 3, to += 4) {
    bytes[to] = pixels[from] as number;
    bytes[to + 1] = pixels[from + 1] as number;
    bytes[to + 2] = pixels[from + 2] as number;
    bytes[to + 3] = 255;
  }
  target.ctx.putImageData(target.image, 0, 0);
}

// A curve over the whole width; samples that are not finite leave a gap. The caller clears.
export function paintCurve(ctx: CanvasRenderingContext2D, values: ArrayLike<number>, how: Curve): void {
  const { width, height, lower, upper, color, above = color, zero, lineWidth = 1.5 } = how;
  const factor = upper > lower ? height / (upper - lower) : 0;
  const place = (value: number) => height - (value - lower) * factor;
  if (zero !== undefined && lower <= 0 && upper >= 0) {
    const y = Math.round(place(0)) + 0.5;
    ctx.strokeStyle = zero;
    ctx.lineWidth = 1;
    strokeLines(ctx, [0, y, width, y]);
  }
  ctx.lineWidth = lineWidth;
  ctx.lineJoin = "round";
  if (above === color || lower >= 0 || upper <= 0) {
    ctx.strokeStyle = lower >= 0 ? above : color;
    trace(ctx, values, width, place);
    return;
  }
  // each colour where it belongs; the edges of the picture cut nothing
  for (const [ink, top, bottom] of [
    [color, place(0), height + lineWidth],
    [above, -lineWidth, place(0)],
  ] as const) {
    ctx.save();
    ctx.beginPath();
    ctx.rect(-lineWidth, top, width + 2 * lineWidth, bottom - top);
    ctx.clip();
    ctx.strokeStyle = ink;
    trace(ctx, values, width, place);
    ctx.restore();
  }
}

function trace(
  ctx: CanvasRenderingContext2D,
  values: ArrayLike<number>,
  width: number,
  place: (value: number) => number,
): void {
  const step = values.length > 1 ? width / (values.length - 1) : 0;
  ctx.beginPath();
  let drawing = false;
  for (let i = 0; i < values.length; i++) {
    const value = values[i] as number;
    if (!Number.isFinite(value)) {
      drawing = false;
      continue;
    }
    const y = place(value);
    if (drawing) {
      ctx.lineTo(i * step, y);
    } else {
      ctx.moveTo(i * step, y);
      drawing = true;
    }
  }
  ctx.stroke();
}

function imageOf(canvas: HTMLCanvasElement, nx: number, ny: number): Surface | null {
  if (nx < 1 || ny < 1) {
    return null;
  }
  if (canvas.width !== nx || canvas.height !== ny) {
    canvas.width = nx;
    canvas.height = ny;
  }
  const known = images.get(canvas);
  if (known !== undefined && known.image.width === nx && known.image.height === ny) {
    return known;
  }
  // Kept by the processor: pixels that come from there need not go elsewhere first.
  const ctx = canvas.getContext("2d", canvasSettings());
  if (ctx === null) {
    return null;
  }
  const image = new ImageData(nx, ny);
  const made = { ctx, image, words: new Uint32Array(image.data.buffer) };
  images.set(canvas, made);
  return made;
}

// The colours as pixels of a canvas on a little-endian machine, which every machine with a browser is.
function asWords(scale: ColorTable): Uint32Array {
  let found = words.get(scale);
  if (found === undefined) {
    found = new Uint32Array(scale.buffer, scale.byteOffset, 256);
    words.set(scale, found);
  }
  return found;
}
