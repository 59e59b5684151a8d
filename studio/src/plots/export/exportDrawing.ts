// A plot as a file: drawn again in the colours of paper, with its title and legend, as PNG at twice its size
// or as SVG.

import uPlot from "uplot";
import { font, isSmall, type Look, paperLook } from "../colors/look";
import { drawSceneFrame, type SceneFrame } from "../scenes/sceneFrame";
import type { Viewpoint } from "../scenes/sceneView";
import { saveFile } from "./save";
import { recordingPaths, SvgContext } from "./svgContext";
import type { ChartOptions } from "../chart/useChart";

export type DrawingFormat = "png" | "svg";

export type LegendEntry = { label: string; color: string };

export type PlotDrawing = {
  title: string;
  width: number;
  height: number;
  options: (look: Look) => ChartOptions;
  data: uPlot.AlignedData;
  legend?: (look: Look) => LegendEntry[];
  // Lies under the axes and fills their inside.
  image?: HTMLCanvasElement;
};

// Units of a drawing for each pixel of the page. Charts round lengths to units.
const FACTORS: Record<DrawingFormat, number> = { png: 2, svg: 8 };
const HEAD = 26;
const LINE = 20;
const MARGIN = 10;
const SWATCH = 14;

// Save a chart.
export async function exportDrawing(drawing: PlotDrawing, format: DrawingFormat): Promise<void> {
  const { title, width } = drawing;
  const legend = placed(drawing.legend?.(paperLook(1)) ?? [], width);
  const lines = legend.reduce((most, { line }) => Math.max(most, line + 1), 0);
  const sheet = new Sheet(format, title, width, drawing.height + HEAD + LINE * lines);
  await addChart(sheet, drawing, format, 0, HEAD + LINE * lines);
  drawLegend(sheet, legend);
  sheet.save();
}

// Save several charts as they are on the page, each below its title.
export async function exportMultiples(
  title: string,
  cells: { drawing: () => PlotDrawing | null; host: HTMLElement | null }[],
  format: DrawingFormat,
): Promise<void> {
  const boxes = cells.map(({ host }) => host?.getBoundingClientRect() ?? new DOMRect());
  const [left, top] = [Math.min(...boxes.map((box) => box.left)), Math.min(...boxes.map((box) => box.top))];
  const right = Math.max(...boxes.map((box) => box.right));
  const bottom = Math.max(...boxes.map((box) => box.bottom));
  const sheet = new Sheet(format, title, right - left, bottom - top + HEAD + LINE);
  const { ctx, factor } = sheet;
  for (const [i, { drawing }] of cells.entries()) {
    const [box, made] = [boxes[i], drawing()];
    if (box !== undefined && made !== null) {
      const [x, y] = [box.left - left, box.top - top + HEAD + LINE];
      ctx.font = `600 ${font(paperLook(factor))}`;
      ctx.fillStyle = paperLook(factor).text;
      ctx.textBaseline = "middle";
      ctx.fillText(made.title, (x + 6) * factor, (y - LINE / 2) * factor, box.width * factor);
      await addChart(sheet, made, format, x, y);
    }
  }
  sheet.save();
}

let added = 0;

async function addChart(
  { ctx, factor }: Sheet,
  drawing: PlotDrawing,
  format: DrawingFormat,
  x: number,
  y: number,
): Promise<void> {
  const { chart, content } = await drawnAgain(drawing, format, factor);
  if (drawing.image !== undefined) {
    const { left, top, width, height } = chart.bbox;
    ctx.imageSmoothingEnabled = false;
    ctx.drawImage(drawing.image, x * factor + left, y * factor + top, width, height);
  }
  if (content instanceof SvgContext) {
    (ctx as unknown as SvgContext).include(content, x * factor, y * factor);
  } else {
    ctx.drawImage(chart.ctx.canvas, x * factor, y * factor);
  }
  chart.destroy();
}

// Save a picture without axes: its samples become squares.
export function exportPicture(title: string, image: HTMLCanvasElement, format: DrawingFormat): void {
  const square = Math.max(1, Math.floor(640 / Math.max(image.width, image.height))) / 2;
  const [width, height] = [image.width * square, image.height * square];
  const sheet = new Sheet(format, title, width + 16, height + HEAD + 8);
  const { ctx, factor } = sheet;
  ctx.imageSmoothingEnabled = false;
  ctx.drawImage(image, 8 * factor, HEAD * factor, width * factor, height * factor);
  sheet.save();
}

export type DrawnScene = {
  width: number;
  height: number;
  frame: SceneFrame;
  view: Viewpoint;
  image: HTMLCanvasElement;
};

// Save a scene in three dimensions: its frame, and above it the image.
export function exportScene(title: string, scene: DrawnScene, format: DrawingFormat): void {
  const { width, height, frame, view, image } = scene;
  const sheet = new Sheet(format, title, width, height + HEAD);
  const { ctx, factor } = sheet;
  ctx.save();
  ctx.translate(0, HEAD * factor);
  drawSceneFrame(ctx, frame, view, paperLook(factor), width, height);
  ctx.drawImage(image, 0, 0, width * factor, height * factor);
  ctx.restore();
  sheet.save();
}

// A canvas, or an SVG with the interface of one, with the title of a drawing.
class Sheet {
  readonly ctx: CanvasRenderingContext2D;
  readonly factor: number;
  readonly save: () => void;

  constructor(format: DrawingFormat, title: string, width: number, height: number) {
    const factor = FACTORS[format];
    const look = paperLook(factor);
    const canvas = document.createElement("canvas");
    canvas.width = Math.round(width * factor);
    canvas.height = Math.round(height * factor);
    const ctx = format === "svg" ? asCanvasContext(new SvgContext("sheet")) : canvas.getContext("2d");
    if (ctx === null) {
      throw new Error("The browser gives no canvas to draw on.");
    }
    ctx.fillStyle = look.ground;
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    ctx.fillStyle = look.text;
    ctx.font = `600 ${font(look, 13)}`;
    ctx.textBaseline = "middle";
    ctx.fillText(title, MARGIN * factor, (HEAD / 2) * factor, canvas.width - 2 * MARGIN * factor);
    this.ctx = ctx;
    this.factor = factor;
    this.save = () => {
      if (format === "png") {
        canvas.toBlob((blob) => blob !== null && saveFile(blob, title, format), "image/png");
      } else {
        const text = (ctx as unknown as SvgContext).document(width, height, factor);
        saveFile(new Blob([text], { type: "image/svg+xml" }), title, format);
      }
    };
  }
}

type DrawnChart = { chart: uPlot; content: SvgContext | null };

async function drawnAgain(drawing: PlotDrawing, format: DrawingFormat, factor: number): Promise<DrawnChart> {
  // uPlot multiplies by the device's pixels itself.
  const look = paperLook(factor / devicePixelRatio, isSmall(drawing.width, drawing.height));
  const size = {
    width: Math.round(drawing.width * look.unit),
    height: Math.round(drawing.height * look.unit),
  };
  const make = () =>
    new uPlot({ ...drawing.options(look), ...size }, drawing.data, document.createElement("div"));
  const drawn = () => new Promise((done) => setTimeout(done));
  if (format === "png") {
    const chart = make();
    await drawn();
    return { chart, content: null };
  }
  const content = new SvgContext(`chart-${++added}`);
  const chart = await recordingPaths(async () => {
    const made = withContext(asCanvasContext(content), make);
    await drawn();
    return made;
  });
  return { chart, content };
}

// uPlot asks for the context of its canvas while it is made.
function withContext<T>(ctx: CanvasRenderingContext2D, make: () => T): T {
  const asked = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = (() => ctx) as unknown as typeof asked;
  try {
    return make();
  } finally {
    HTMLCanvasElement.prototype.getContext = asked;
  }
}

// It has the methods of a canvas context that charts call.
function asCanvasContext(context: SvgContext): CanvasRenderingContext2D {
  return context as unknown as CanvasRenderingContext2D;
}

type Placed = { entry: LegendEntry; x: number; line: number };

// The positions of the entries of a legend, in lines no longer than the sheet.
function placed(entries: LegendEntry[], width: number): Placed[] {
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

function drawLegend({ ctx, factor }: Sheet, places: Placed[]): void {
  const look = paperLook(factor);
  ctx.font = font(look);
  ctx.textBaseline = "middle";
  for (const { entry, x, line } of places) {
    const y = (HEAD + (line + 0.5) * LINE) * factor;
    ctx.fillStyle = entry.color;
    ctx.fillRect(x * factor, y - factor, SWATCH * factor, 2 * factor);
    ctx.fillStyle = look.text;
    ctx.fillText(entry.label, (x + SWATCH + 4) * factor, y);
  }
}
