// The sides of a drawing: where its inside is, and the ticks, numbers and names around it.

import { axisLabel } from "./axis";
import { colorsOf, type Content, rasterOf, type PlotSide } from "./content";
import { fitting, font, type Ink, strokeLines, widthOf } from "./ink";
import type { Range } from "./scale";
import { ticks } from "./scale";
import { tick, writtenTime } from "./text";

export type Area = Readonly<{ left: number; top: number; width: number; height: number }>;

type Tick = { place: number; text: string };

// From values to lengths and back.
export type Scale = Readonly<{ place: (value: number) => number; value: (place: number) => number }>;

export type PlotLayout = Readonly<{
  box: Area;
  x: Scale;
  y: Scale;
  right: Scale | null;
  // Where an axis is drawn: below, on the left.
  strips: readonly [Area, Area];
}>;

// The room around the inside in pixels of the page: of a drawing, of one with a colour bar, of a small one.
const PADDING = { plain: [8, 18, 0, 4], bar: [10, 66, 0, 4], small: [6, 12, 0, 2] } as const;
const NAME = 16;

type Sizes = { font: number; edge: number; low: number; tick: number; gap: number; apart: number };
const LARGE: Sizes = { font: 11, edge: 12, low: 20, tick: 4, gap: 4, apart: 26 };
const SMALL: Sizes = { font: 10, edge: 7, low: 15, tick: 3, gap: 2, apart: 20 };
const sizesOf = (ink: Ink): Sizes => (ink.small ? SMALL : LARGE);

export function nameOf({ along, label = "", unit = "" }: PlotSide): string {
  if (along !== "time") {
    return along === null ? label : axisLabel(along);
  }
  const written = writtenTime(unit).unit;
  return written === "" ? "time" : `time (${written})`;
}

export function layout(content: Content, ink: Ink, width: number, height: number): PlotLayout {
  const { unit, small } = ink;
  const { low, edge, font: size, apart } = sizesOf(ink);
  const bar = colorsOf(content) !== null;
  const padding = small ? PADDING.small : bar ? PADDING.bar : PADDING.plain;
  const [top, free, , before] = padding.map((length) => length * unit) as [number, number, number, number];
  const named = (side: PlotSide) => (small || nameOf(side) === "" ? 0 : NAME * unit);
  const beside = (side: PlotSide, room: number) => {
    const texts = ticksOf(side, room, room / (apart * unit)).map(({ text }) => text.length);
    return (edge + widthOf("0", size) * Math.max(small ? 2 : 3, ...texts)) * unit + named(side);
  };
  const below = low * unit + named(content.x);
  const most = Math.max(1, height - top - below);
  const left = before + beside(content.y, most);
  const after = content.right === undefined || small ? free : beside(content.right, most);
  const room = { left, top, width: Math.max(1, width - left - after), height: most };
  const box = whole(content.equal === true ? squared(room, content) : room);
  return {
    box,
    x: scaleOf(content.x.range, box.left, box.left + box.width, content.x.down),
    y: scaleOf(content.y.range, box.top + box.height, box.top, content.y.down),
    right:
      content.right === undefined ? null : scaleOf(content.right.range, box.top + box.height, box.top, false),
    strips: [
      { left: box.left, top: box.top + box.height, width: box.width, height: below },
      { left: box.left - (left - before), top: box.top, width: left - before, height: box.height },
    ],
  };
}

// The largest part of a room, in its middle, in which both sides have the same scale.
function squared({ left, top, width, height }: Area, { x, y }: Content): Area {
  const extents = [x.range[1] - x.range[0], y.range[1] - y.range[0]] as const;
  const scale = Math.min(width / extents[0], height / extents[1]);
  const [across, down] = [scale * extents[0], scale * extents[1]];
  return { left: left + (width - across) / 2, top: top + (height - down) / 2, width: across, height: down };
}

function whole({ left, top, width, height }: Area): Area {
  const [x, y] = [Math.round(left), Math.round(top)];
  return { left: x, top: y, width: Math.round(left + width) - x, height: Math.round(top + height) - y };
}

function scaleOf([lower, upper]: Range, first: number, last: number, turned = false): Scale {
  const [from, to] = turned ? [last, first] : [first, last];
  const factor = (to - from) / (upper - lower || 1);
  return {
    place: (value) => from + (value - lower) * factor,
    value: (place) => lower + (place - from) / factor,
  };
}

// Round places on a side, as shares of its range; times in the unit in which they are written.
function ticksOf({ along, range, unit = "" }: PlotSide, length: number, most: number): Tick[] {
  const { factor } = along === "time" ? writtenTime(unit) : { factor: 1 };
  const [lower, upper] = [range[0] * factor, range[1] * factor];
  const { places, step } = ticks([lower, upper], most);
  return places.map((value) => ({
    place: (length * (value - lower)) / (upper - lower || 1),
    text: tick(value, step),
  }));
}

// The ticks of the lower side, so far apart that their numbers stay apart: at a comfortable distance, or
// closer where there would be less than two.
function ticksBelow(side: PlotSide, length: number, size: number): Tick[] {
  const comfortable = Math.max(1, Math.floor(length / (5 * size)));
  for (let most = comfortable; most >= 1; most--) {
    const found = ticksOf(side, length, most);
    if (found.length > 1 && areApart(found, size)) {
      return found;
    }
  }
  const closer = ticksOf(side, length, length / (2.5 * size));
  return areApart(closer, size) ? closer : closer.slice(0, 1);
}

function areApart(found: readonly Tick[], size: number): boolean {
  const wide = Math.max(...found.map(({ text }) => widthOf(text, size))) + 0.6 * size;
  return found.every(({ place }, i) => i === 0 || place - (found[i - 1]?.place ?? 0) >= wide);
}

export function drawAxes(
  ctx: CanvasRenderingContext2D,
  content: Content,
  { box, right }: PlotLayout,
  ink: Ink,
  width: number,
): void {
  const { unit, small } = ink;
  const { font: size, tick: mark, gap, apart } = sizesOf(ink);
  const { x, y } = content;
  const grid = rasterOf(content) === null;
  const [far, foot] = [box.left + box.width, box.top + box.height];
  const count = box.height / (apart * unit);
  const up = (side: PlotSide) =>
    ticksOf(side, box.height, count).map(({ place, text }) => ({
      at: Math.round(side.down === true ? box.top + place : foot - place),
      text,
    }));
  const across = ticksBelow(x, box.width, size * unit).map(({ place, text }) => ({
    at: Math.round(box.left + place),
    text,
  }));
  const upward = up(y);
  const end = (mark + gap) * unit;
  const line = (color: string, ...lines: Parameters<typeof strokeLines>[1][]) => {
    ctx.strokeStyle = color;
    strokeLines(ctx, ...lines);
  };
  const half = (unit % 2) / 2;
  ctx.save();
  ctx.lineWidth = unit;
  ctx.translate(half, half);
  if (grid) {
    line(
      ink.grid,
      ...across.map(({ at }) => [at, box.top, at, foot] as const),
      ...upward.map(({ at }) => [box.left, at, far, at] as const),
    );
  }
  line(
    ink.dim,
    [box.left, box.top, box.left, foot],
    [box.left, foot, far, foot],
    ...across.map(({ at }) => [at, foot, at, foot + mark * unit] as const),
    ...upward.map(({ at }) => [box.left - mark * unit, at, box.left, at] as const),
  );
  ctx.translate(-half, -half);
  ctx.fillStyle = ink.dim;
  ctx.font = font(ink, size);
  ctx.textAlign = "center";
  ctx.textBaseline = "top";
  for (const { at, text } of across) {
    const reach = widthOf(text, size * unit) / 2;
    ctx.fillText(text, Math.max(reach, Math.min(width - reach, at)), foot + end);
  }
  ctx.textAlign = "right";
  ctx.textBaseline = "middle";
  for (const { at, text } of upward) {
    ctx.fillText(text, box.left - end, at);
  }
  if (!small) {
    ctx.textAlign = "center";
    ctx.textBaseline = "bottom";
    const bottom = foot + (LARGE.low + NAME) * unit;
    ctx.fillText(fitting(nameOf(x), size * unit, box.width), box.left + box.width / 2, bottom);
    const widest = Math.max(3, ...upward.map(({ text }) => text.length)) * widthOf("0", size);
    upright(ctx, nameOf(y), box, box.left - (LARGE.edge + widest) * unit, ink);
    if (content.right !== undefined && right !== null) {
      const beside = up(content.right);
      line(ink.dim, ...beside.map(({ at }) => [far, at, far + mark * unit, at] as const));
      ctx.textAlign = "left";
      ctx.textBaseline = "middle";
      beside.forEach(({ at, text }) => ctx.fillText(text, far + end, at));
      const reach = Math.max(3, ...beside.map(({ text }) => text.length)) * widthOf("0", size);
      upright(ctx, nameOf(content.right), box, far + (LARGE.edge + reach + NAME) * unit, ink);
    }
  }
  ctx.restore();
}

// The name of an upright side, read from below; `left` is the edge of its room at the ticks.
function upright(
  ctx: CanvasRenderingContext2D,
  name: string,
  { top, height }: Area,
  foot: number,
  ink: Ink,
): void {
  const { font: size } = sizesOf(ink);
  ctx.save();
  ctx.translate(foot, top + height / 2);
  ctx.rotate(-Math.PI / 2);
  ctx.textAlign = "center";
  ctx.textBaseline = "bottom";
  ctx.fillText(fitting(name, size * ink.unit, height), 0, 0);
  ctx.restore();
}
