// The marks inside the sides of a drawing.

import type { PlotLayout, Scale } from "./axes";
import type { Content, LevelLine, CurveLine, PlotMark, Moment, Raster, Tail, Windows } from "./content";
import { fitting, font, type Ink, type Shade, strokeLines } from "./ink";
import { paintHeat, paintPicture } from "./paint";
import { short } from "./text";

type MarkPlace = Readonly<{ ctx: CanvasRenderingContext2D; content: Content; layout: PlotLayout; ink: Ink }>;

const SHADE = 0.12;
const GLOW = 0.13;
const DASH = [5, 4];
const DASH_WIDTH = 1.25;
const LABEL = { size: 10.5, height: 13, left: 6 };
const TAIL = { parts: 32, faintest: 0.08, width: 1.75, dot: 4 };
const MOST_COLUMNS = 800;

export function drawMarks(place: MarkPlace): void {
  const { ctx, content, layout } = place;
  const { left, top, width, height } = layout.box;
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, width, height);
  ctx.clip();
  const labels: number[] = [];
  for (const mark of content.marks) {
    drawMark(place, mark, labels);
  }
  ctx.restore();
}

function drawMark(place: MarkPlace, mark: PlotMark, labels: number[]): void {
  switch (mark.type) {
    case "line":
      drawLine(place, mark);
      break;
    case "level":
      drawLevel(place, mark, labels);
      break;
    case "moment":
      drawMoment(place, mark);
      break;
    case "windows":
      drawWindows(place, mark);
      break;
    case "tail":
      drawTail(place, mark);
      break;
    case "map":
    case "picture":
    case "rows": // an image below
  }
}

// Bevelled joins: without a graphics card others cost a fifth more.
function drawLine({ ctx, layout, ink }: MarkPlace, mark: CurveLine): void {
  const { color, above, width, right, dashed = false } = mark;
  const up: Scale = right === true && layout.right !== null ? layout.right : layout.y;
  const pieces = linePieces(mark, layout.x, up);
  ctx.lineWidth = width * ink.unit;
  ctx.lineJoin = "bevel";
  ctx.setLineDash(dashed ? DASH.map((length) => length * ink.unit) : []);
  const { left, top, width: across, height } = layout.box;
  const threshold = Math.min(top + height, Math.max(top, up.place(above?.value ?? Infinity)));
  if (above === undefined || !pieces.some((piece) => piece.some(([, y]) => y < threshold))) {
    strokePieces(ctx, pieces, color[ink.shade]);
    return;
  }
  const inside = (from: number, to: number, draw: () => void) => {
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, from, across, to - from);
    ctx.clip();
    draw();
    ctx.restore();
  };
  inside(threshold, top + height, () => strokePieces(ctx, pieces, color[ink.shade]));
  inside(top, threshold, () => {
    ctx.fillStyle = above.color[ink.shade];
    ctx.globalAlpha = GLOW;
    fillPieces(ctx, pieces, threshold);
    ctx.globalAlpha = 1;
    strokePieces(ctx, pieces, above.color[ink.shade]);
  });
}

type PixelPoint = readonly [x: number, y: number];

// The line as pieces between gaps, on whole pixels. Of many samples in one column of pixels the first, the
// least, the greatest and the last.
function linePieces({ xs, ys }: CurveLine, x: Scale, y: Scale): PixelPoint[][] {
  const pieces: PixelPoint[][] = [];
  let piece: PixelPoint[] = [];
  let column = NaN;
  let [low, high, last] = [0, 0, 0];
  const leave = () => {
    if (Number.isNaN(column)) {
      return;
    }
    if (low < high) {
      piece.push([column, low], [column, high]);
    }
    if (last !== high && low < high) {
      piece.push([column, last]);
    }
  };
  for (let i = 0; i < xs.length; i++) {
    const value = ys[i];
    if (value == null || !Number.isFinite(value)) {
      leave();
      column = NaN;
      continue;
    }
    const [at, height] = [Math.round(x.place(xs[i] as number)), Math.round(y.place(value))];
    if (at === column) {
      [low, high, last] = [Math.min(low, height), Math.max(high, height), height];
      continue;
    }
    leave();
    if (Number.isNaN(column)) {
      piece = [];
      pieces.push(piece);
    }
    piece.push([at, height]);
    column = at;
    [low, high, last] = [height, height, height];
  }
  leave();
  return pieces;
}

function strokePieces(ctx: CanvasRenderingContext2D, pieces: readonly PixelPoint[][], color: string): void {
  ctx.strokeStyle = color;
  ctx.beginPath();
  for (const piece of pieces) {
    piece.forEach(([x, y], i) => (i === 0 ? ctx.moveTo(x, y) : ctx.lineTo(x, y)));
  }
  ctx.stroke();
}

// What lies between the pieces and a line across.
function fillPieces(ctx: CanvasRenderingContext2D, pieces: readonly PixelPoint[][], across: number): void {
  ctx.beginPath();
  for (const piece of pieces) {
    const [first, last] = [piece[0], piece[piece.length - 1]];
    if (first === undefined || last === undefined) {
      continue;
    }
    ctx.moveTo(first[0], across);
    piece.forEach(([x, y]) => ctx.lineTo(x, y));
    ctx.lineTo(last[0], across);
    ctx.closePath();
  }
  ctx.fill();
}

// A line across; its name is above it, or below, where neither another name nor the edge is.
function drawLevel(
  { ctx, layout, ink }: MarkPlace,
  { label, value, color }: LevelLine,
  labels: number[],
): void {
  const { left, top, width, height } = layout.box;
  const { unit } = ink;
  const y = Math.round(layout.y.place(value));
  ctx.strokeStyle = color[ink.shade];
  ctx.fillStyle = color[ink.shade];
  dashedLine(ctx, ink, [left, y, left + width, y]);
  if (ink.small || label === "") {
    return;
  }
  const room = LABEL.height * unit;
  const place = [y - room / 2, y + room / 2].find(
    (at) =>
      at >= top + room / 2 &&
      at <= top + height - room / 2 &&
      labels.every((other) => Math.abs(other - at) >= room),
  );
  if (place !== undefined) {
    labels.push(place);
    ctx.font = font(ink, LABEL.size);
    ctx.textAlign = "left";
    ctx.textBaseline = "middle";
    const text = fitting(`${label} ${short(value)}`, LABEL.size * unit, width - LABEL.left * unit);
    ctx.fillText(text, left + LABEL.left * unit, place);
  }
}

// On a halo, so that it is seen on every colour of a map.
function drawMoment({ ctx, content, layout, ink }: MarkPlace, { time }: Moment): void {
  const { left, top, width, height } = layout.box;
  const down = content.y.along === "time";
  const at = Math.round((down ? layout.y : layout.x).place(time));
  ctx.strokeStyle = ink.text;
  const ends = down ? [left, at, left + width, at] : [at, top, at, top + height];
  dashedLine(ctx, ink, ends as [number, number, number, number], true);
}

function dashedLine(
  ctx: CanvasRenderingContext2D,
  ink: Ink,
  ends: readonly [number, number, number, number],
  halo = false,
): void {
  if (halo) {
    const before = ctx.strokeStyle;
    ctx.strokeStyle = ink.ground;
    ctx.lineWidth = 3.5 * ink.unit;
    ctx.setLineDash([]);
    strokeLines(ctx, ends);
    ctx.strokeStyle = before;
  }
  ctx.lineWidth = DASH_WIDTH * ink.unit;
  ctx.setLineDash(DASH.map((length) => length * ink.unit));
  strokeLines(ctx, ends);
  ctx.setLineDash([]);
}

function drawWindows({ ctx, layout, ink }: MarkPlace, { spans }: Windows): void {
  const { left, top, width, height } = layout.box;
  ctx.fillStyle = ink.text;
  ctx.globalAlpha = SHADE;
  for (const [start, stop] of spans) {
    const from = Math.max(left, layout.x.place(start));
    const to = Math.min(left + width, layout.x.place(stop));
    if (to > from) {
      ctx.fillRect(from, top, to - from, height);
    }
  }
  ctx.globalAlpha = 1;
}

function drawTail({ ctx, layout, ink }: MarkPlace, { xs, ys, color }: Tail): void {
  const x = (i: number) => layout.x.place(xs[i] as number);
  const y = (i: number) => layout.y.place(ys[i] as number);
  const last = xs.length - 1;
  ctx.strokeStyle = color[ink.shade];
  ctx.fillStyle = color[ink.shade];
  ctx.lineWidth = TAIL.width * ink.unit;
  ctx.lineJoin = "round";
  for (let part = 0; part < TAIL.parts; part++) {
    const from = Math.floor((part * last) / TAIL.parts);
    const to = Math.floor(((part + 1) * last) / TAIL.parts);
    if (to > from) {
      ctx.globalAlpha = TAIL.faintest + (1 - TAIL.faintest) * ((part + 1) / TAIL.parts) ** 2;
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
    ctx.arc(x(last), y(last), TAIL.dot * ink.unit, 0, 2 * Math.PI);
    ctx.fill();
  }
}

// The image of a map: a pixel for each value. Time has a column for each pixel, `most` of them.
export function paintRaster(
  canvas: HTMLCanvasElement,
  raster: Raster,
  { x, y }: Pick<Content, "x" | "y">,
  { width, height, shade }: Readonly<{ width: number; height: number; shade: Shade }>,
): void {
  if (raster.type === "picture") {
    paintPicture(canvas, raster.values, raster.nx, raster.ny, [0, 1], y.down !== true);
    return;
  }
  const { range } = raster.colors;
  const table = raster.colors.tables[shade];
  if (raster.type === "map") {
    paintHeat(canvas, raster.values, raster.nx, raster.ny, range, table, y.down);
    return;
  }
  const { rows } = raster;
  const across = x.along === "time";
  const columns = Math.round(Math.max(1, Math.min(MOST_COLUMNS, across ? width : height)));
  const values = rows.spread(across ? x.range : y.range, columns);
  if (across) {
    paintHeat(canvas, values, columns, rows.width, range, table, y.down);
  } else {
    paintHeat(canvas, turned(values, columns, rows.width), rows.width, columns, range, table, y.down);
  }
}

// The values with both axes exchanged.
function turned(values: Float32Array, columns: number, width: number): Float32Array {
  const out = new Float32Array(values.length);
  for (let i = 0; i < columns; i++) {
    for (let j = 0; j < width; j++) {
      out[j * columns + i] = values[i * width + j] as number;
    }
  }
  return out;
}
