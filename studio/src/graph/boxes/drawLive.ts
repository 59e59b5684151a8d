// One live picture inside a box; its form follows from the shape of the data alone.

import type { Shade } from "../../draw/ink";
import { type ColorTable, paintCurve, paintHeat, paintPicture } from "../../draw/paint";
import { activationScale, amounts, FIELD_COLORS, portColor, shade } from "../../model/colors";
import type { Live } from "../../server/streams";
import { follow, open, type Span } from "../../model/span";
import { LIVE } from "../../architecture/boxes";
import { short } from "../../model/facts";

export type Canvas = {
  element: HTMLCanvasElement;
  width: number;
  height: number;
  span: Span | null;
  port: string;
};

// A screen's own pixels, but not more than pay for themselves in a box this small.
const ratio = (): number => Math.min(2, window.devicePixelRatio);

export function drawLive(canvas: Canvas, { form, frame }: Live): void {
  const values = frame?.values;
  if (form === null || values === undefined) {
    clear(canvas);
    return;
  }
  if (form.channels) {
    squares(canvas, true);
    canvas.element.style.objectFit = "contain";
    paintPicture(canvas.element, values, form.shape[0] ?? 1, form.shape[1] ?? 1);
    return;
  }
  canvas.span = follow(canvas.span, values);
  const { lower, upper } = open(canvas.span);
  if (form.shape.length === 0) {
    drawNumber(canvas, values[0] ?? NaN, lower, upper);
  } else if (form.shape.length === 1) {
    drawCurve(canvas, values, lower, upper);
  } else {
    squares(canvas, true);
    const map =
      lower < 0
        ? activationOf(canvas.element, { lower, upper })
        : { lower, upper, table: amounts(canvas.port)[shade()] };
    const [nx = 1, ny = 1] = form.shape;
    paintHeat(canvas.element, values, nx, ny, [map.lower, map.upper], map.table);
  }
}

type SpanColors = Readonly<{ lower: number; upper: number; table: ColorTable }>;

// The colours of a range around 0 change with it in small steps: a table takes a third of a millisecond.
const STEP = 0.01;
const colors = new WeakMap<HTMLCanvasElement, SpanColors>();

function activationOf(canvas: HTMLCanvasElement, { lower, upper }: Span): SpanColors {
  const before = colors.get(canvas);
  const most = STEP * (upper - lower);
  if (
    before !== undefined &&
    Math.abs(before.lower - lower) <= most &&
    Math.abs(before.upper - upper) <= most
  ) {
    return before;
  }
  const next = { lower, upper, table: activationScale(lower, upper, 0) };
  colors.set(canvas, next);
  return next;
}

export function clear(canvas: Canvas): void {
  prepared(canvas);
}

// Words in place of a picture.
export function drawWords(canvas: Canvas, words: string): void {
  const ctx = prepared(canvas);
  if (ctx !== null) {
    ctx.fillStyle = ink().dim;
    ctx.font = ink().font;
    ctx.textAlign = "center";
    ctx.textBaseline = "middle";
    ctx.fillText(words, canvas.width / 2, canvas.height / 2);
  }
}

function drawCurve(canvas: Canvas, values: Float32Array, lower: number, upper: number): void {
  const ctx = prepared(canvas);
  if (ctx === null) {
    return;
  }
  const { width, height, port } = canvas;
  const edge = 3;
  ctx.translate(0, edge);
  const how = {
    width,
    height: height - 2 * edge,
    lower,
    upper,
    color: portColor(port, [port], shade()),
    above: aboveColor(port),
    zero: ink().line,
  };
  paintCurve(ctx, values.length === 1 ? [values[0] as number, values[0] as number] : values, how);
}

function drawNumber(canvas: Canvas, value: number, lower: number, upper: number): void {
  const ctx = prepared(canvas);
  if (ctx === null) {
    return;
  }
  const { width, height, port } = canvas;
  const bar = width < LIVE.width ? width : width - 58;
  const place = (v: number) => (bar * (v - lower)) / (upper - lower);
  const middle = Math.round(height / 2);
  ctx.fillStyle = ink().ground;
  ctx.fillRect(0, middle - 4, bar, 8);
  if (Number.isFinite(value)) {
    ctx.fillStyle = value > 0 ? aboveColor(port) : portColor(port, [port], shade());
    ctx.fillRect(Math.min(place(0), place(value)), middle - 4, Math.abs(place(value) - place(0)), 8);
  }
  ctx.fillStyle = ink().line;
  ctx.fillRect(Math.round(place(0)), middle - 6, 1, 12);
  if (bar === width) {
    return;
  }
  ctx.fillStyle = ink().text;
  ctx.font = ink().font;
  ctx.textAlign = "right";
  ctx.textBaseline = "middle";
  ctx.fillText(Number.isFinite(value) ? rounded(value) : "not finite", width - 2, middle + 0.5);
}

// The colour of a port above 0: activation has one of its own there.
function aboveColor(port: string): string {
  return port === "activation" ? FIELD_COLORS[shade()].ember : portColor(port, [port], shade());
}

// Digits that change slowly enough to be read.
function rounded(value: number): string {
  return Math.abs(value) >= 1000 || (value !== 0 && Math.abs(value) < 0.01)
    ? short(Number(value.toPrecision(3)))
    : value.toFixed(2).replace("-", "−");
}

function prepared(canvas: Canvas): CanvasRenderingContext2D | null {
  const { element, width, height } = canvas;
  squares(canvas, false);
  const scale = ratio();
  const [w, h] = [Math.round(width * scale), Math.round(height * scale)];
  if (element.width !== w || element.height !== h) {
    element.width = w;
    element.height = h;
  }
  const ctx = element.getContext("2d");
  ctx?.setTransform(scale, 0, 0, scale, 0, 0);
  ctx?.clearRect(0, 0, width, height);
  return ctx;
}

// Samples of a heat map are seen as squares, not as a blur.
function squares({ element }: Canvas, on: boolean): void {
  element.style.imageRendering = on ? "pixelated" : "auto";
}

type BoxInk = { dim: string; line: string; ground: string; text: string; font: string };

const inks = new Map<Shade, BoxInk>();

// The colours of the page, read once for light and once for dark.
function ink(): BoxInk {
  const now = shade();
  let found = inks.get(now);
  if (found === undefined) {
    const style = getComputedStyle(document.documentElement);
    const read = (name: string) => style.getPropertyValue(name).trim();
    found = {
      dim: read("--dim"),
      line: read("--edge"),
      ground: read("--line"),
      text: read("--text"),
      font: `12px ${getComputedStyle(document.body).fontFamily}`,
    };
    inks.set(now, found);
  }
  return found;
}
