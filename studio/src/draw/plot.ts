// A whole plot onto a context: sides, marks, colour bar.

import { drawAxes, layout, type PlotLayout } from "./axes";
import { drawColorBar } from "./bar";
import { colorsOf, type Content } from "./content";
import type { Ink } from "./ink";
import { drawMarks } from "./marks";

type PlotSheet = Readonly<{
  ctx: CanvasRenderingContext2D;
  ink: Ink;
  width: number;
  height: number;
  // Fills the inside, below everything else.
  image?: HTMLCanvasElement | null;
}>;

export function drawPlot({ ctx, ink, width, height, image = null }: PlotSheet, content: Content): PlotLayout {
  const placed = layout(content, ink, width, height);
  if (image !== null) {
    const { left, top, width: across, height: down } = placed.box;
    ctx.imageSmoothingEnabled = false;
    ctx.drawImage(image, left, top, across, down);
  }
  drawAxes(ctx, content, placed, ink, width);
  drawMarks({ ctx, content, layout: placed, ink });
  const colors = colorsOf(content);
  if (colors !== null) {
    drawColorBar(ctx, placed.box, ink, colors);
  }
  return placed;
}
