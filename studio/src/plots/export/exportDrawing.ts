// A plot as a file: drawn again in the colours of paper, with its title and legend, as PNG at twice its size
// or as SVG.

import { type Content, rasterOf } from "../../draw/content";
import { font, isSmall, type Paint, paperInk } from "../../draw/ink";
import { paintRaster } from "../../draw/marks";
import { drawPlot } from "../../draw/plot";
import { SvgContext } from "../../draw/svg";
import { drawSceneFrame, type SceneFrame } from "./sceneFrame";
import type { Viewpoint } from "../../model/sceneView";
import { saveFile } from "../../server/save";

export type DrawingFormat = "png" | "svg";

type LegendLine = Readonly<{ label: string; color: Paint }>;

type Placed = Readonly<{ x: number; y: number; width: number; height: number; content: Content }>;

// Units of a drawing for each pixel of the page: those of an SVG are as fine as its numbers.
const FACTORS: Record<DrawingFormat, number> = { png: 2, svg: 8 };
const HEAD = 26;
const LINE = 20;
const MARGIN = 10;
const SWATCH = 14;

// Save a plot of a size.
export function exportDrawing(
  title: string,
  drawing: Readonly<{ width: number; height: number; content: Content }>,
  legend: readonly LegendLine[],
  format: DrawingFormat,
): void {
  const { width, height } = drawing;
  const entries = placed(legend, width);
  const lines = entries.reduce((most, { line }) => Math.max(most, line + 1), 0);
  const top = HEAD + LINE * lines;
  const sheet = new Sheet(format, title, width, height + top);
  drawContent(sheet, { x: 0, y: top, ...drawing });
  drawLegend(sheet, entries);
  sheet.save();
}

// Save several plots as they are on the page, each below its name.
export function exportMultiples(
  title: string,
  cells: readonly Readonly<{ name: string; box: DOMRect; content: Content | null }>[],
  format: DrawingFormat,
): void {
  const [left, top] = [
    Math.min(...cells.map(({ box }) => box.left)),
    Math.min(...cells.map(({ box }) => box.top)),
  ];
  const right = Math.max(...cells.map(({ box }) => box.right));
  const bottom = Math.max(...cells.map(({ box }) => box.bottom));
  const sheet = new Sheet(format, title, right - left, bottom - top + HEAD + LINE);
  const { ctx, factor } = sheet;
  for (const { name, box, content } of cells) {
    const [x, y] = [box.left - left, box.top - top + HEAD + LINE];
    ctx.font = `600 ${font(paperInk(factor))}`;
    ctx.fillStyle = paperInk(factor).text;
    ctx.textAlign = "left";
    ctx.textBaseline = "middle";
    ctx.fillText(name, (x + 6) * factor, (y - LINE / 2) * factor, box.width * factor);
    if (content !== null) {
      drawContent(sheet, { x, y, width: box.width, height: box.height, content });
    }
  }
  sheet.save();
}

function drawContent({ ctx, factor }: Sheet, { x, y, width, height, content }: Placed): void {
  const raster = rasterOf(content);
  const image = raster === null ? null : document.createElement("canvas");
  if (raster !== null && image !== null) {
    paintRaster(image, raster, content, { width, height, shade: "light" });
  }
  const ink = paperInk(factor, isSmall(width, height));
  ctx.save();
  ctx.translate(x * factor, y * factor);
  drawPlot({ ctx, ink, width: width * factor, height: height * factor, image }, content);
  ctx.restore();
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
  drawSceneFrame(ctx, frame, view, paperInk(factor), width, height);
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
    const look = paperInk(factor);
    const canvas = document.createElement("canvas");
    canvas.width = Math.round(width * factor);
    canvas.height = Math.round(height * factor);
    const ctx = format === "svg" ? asCanvas(new SvgContext()) : canvas.getContext("2d");
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

// It has the methods of a canvas context that drawings call.
const asCanvas = (context: unknown) => context as CanvasRenderingContext2D;

type PlacedEntry = Readonly<{ entry: LegendLine; x: number; line: number }>;

// The positions of the entries of a legend, in lines no longer than the sheet.
function placed(entries: readonly LegendLine[], width: number): PlacedEntry[] {
  const ctx = document.createElement("canvas").getContext("2d");
  if (ctx === null) {
    return [];
  }
  ctx.font = font(paperInk(1));
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

function drawLegend({ ctx, factor }: Sheet, places: readonly PlacedEntry[]): void {
  const look = paperInk(factor);
  ctx.font = font(look);
  ctx.textBaseline = "middle";
  for (const { entry, x, line } of places) {
    const y = (HEAD + (line + 0.5) * LINE) * factor;
    ctx.fillStyle = entry.color.light;
    ctx.fillRect(x * factor, y - factor, SWATCH * factor, 2 * factor);
    ctx.fillStyle = look.text;
    ctx.fillText(entry.label, (x + SWATCH + 4) * factor, y);
  }
}
