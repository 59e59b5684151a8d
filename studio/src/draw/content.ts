// What a plot shows, as data: two or three sides, and marks between them.

import type { Axis } from "./axis";
import type { Paint } from "./ink";
import type { ColorTables } from "./paint";
import type { Range } from "./scale";

// What the positions on a side are: on an axis of the model, times, or values.
export type Along = Axis | "time" | null;

export type PlotSide = Readonly<{
  along: Along;
  range: Range;
  // The name of values; of an axis and of times it follows from `along`.
  label?: string;
  // The unit of times.
  unit?: string;
  down?: boolean;
}>;

type Series = ArrayLike<number | null>;

export type CurveLine = Readonly<{
  type: "line";
  label: string;
  color: Paint;
  // Above the threshold the line has another colour, and a faint glow down to it.
  above?: Readonly<{ value: number; color: Paint }>;
  width: number;
  xs: ArrayLike<number>;
  ys: Series;
  // Whether its values are on the right side.
  right?: boolean;
  dashed?: boolean;
}>;

export type MapColors = Readonly<{ range: Range; middle: number | null; tables: ColorTables }>;

// An array over both sides as colours. C order: index = ix * ny + iy.
export type ColorMap = Readonly<{
  type: "map";
  label: string;
  values: Float32Array;
  nx: number;
  ny: number;
  colors: MapColors;
}>;

// Red, green and blue over both sides: index = (ix * ny + iy) * 3 + channel.
export type Picture = Readonly<{
  type: "picture";
  label: string;
  values: Float32Array;
  nx: number;
  ny: number;
}>;

// Rows of values over time; `spread` gives them at evenly spaced moments, index = moment * width + sample.
export type TimeRows = Readonly<{
  width: number;
  at: (time: number) => { values: ArrayLike<number> } | null;
  spread: (range: Range, count: number) => Float32Array;
  within: (range: Range) => { times: number[]; values: number[] };
}>;

// Rows over time as colours: one side is time.
export type RowMap = Readonly<{ type: "rows"; label: string; rows: TimeRows; colors: MapColors }>;

// A dashed line across, with a name.
export type LevelLine = Readonly<{ type: "level"; label: string; value: number; color: Paint }>;

// A dashed line at a moment.
export type Moment = Readonly<{ type: "moment"; time: number }>;

// Shaded spans of time.
export type Windows = Readonly<{ type: "windows"; spans: readonly Range[] }>;

// A trajectory that fades into the past, with a dot at its end.
export type Tail = Readonly<{
  type: "tail";
  color: Paint;
  unit: string;
  times: readonly number[];
  xs: readonly number[];
  ys: readonly number[];
}>;

export type Raster = ColorMap | Picture | RowMap;
export type PlotMark = CurveLine | Raster | LevelLine | Moment | Windows | Tail;

export type Content = Readonly<{
  x: PlotSide;
  y: PlotSide;
  right?: PlotSide;
  // Whether both sides have the same scale.
  equal?: boolean;
  marks: readonly PlotMark[];
}>;

export function marksOf<T extends PlotMark["type"]>(
  content: Content,
  type: T,
): Extract<PlotMark, { type: T }>[] {
  return content.marks.filter((mark): mark is Extract<PlotMark, { type: T }> => mark.type === type);
}

// The mark that is an image under the others; a content has one at most.
export function rasterOf({ marks }: Content): Raster | null {
  return marks.find((mark): mark is Raster => ["map", "picture", "rows"].includes(mark.type)) ?? null;
}

// The colours of the values, which a bar explains.
export function colorsOf(content: Content): MapColors | null {
  const raster = rasterOf(content);
  return raster === null || raster.type === "picture" ? null : raster.colors;
}
