// The values of a plot as a table: one row for each position, or moment, with the names and units of axes.

import { type Axis, axisLabel, points } from "./axis";
import { type Content, type CurveLine, marksOf, type Raster, rasterOf, type PlotSide } from "./content";
import { sideBySide } from "./series";

export type TableColumn = ArrayLike<number | null | undefined>;

export type Table = { header: string[]; columns: TableColumn[] };

// An array over one axis, over two, or over two with the channels of a picture.
type ArrayForm = Readonly<{ axes: readonly Axis[]; shape: readonly number[]; channels: boolean }>;

const CHANNELS = ["red", "green", "blue"];

// The table of some contents over the same sides; null: they show nothing. With names, as those of small
// multiples, each content has one column.
export function tableOf(contents: readonly Content[], names?: readonly string[]): Table | null {
  const [first] = contents;
  if (first === undefined) {
    return null;
  }
  const raster = rasterOf(first);
  if (raster !== null) {
    const table = rasterTable(first, raster);
    const others = contents.slice(1).map((content) => rasterTable(content, rasterOf(content) ?? raster));
    const values = others.map(({ columns }) => columns[columns.length - 1] ?? []);
    const places = table.header.slice(0, table.columns.length - 1);
    return names === undefined
      ? table
      : { header: [...places, ...names], columns: [...table.columns, ...values] };
  }
  const [tail] = marksOf(first, "tail");
  if (tail !== undefined) {
    const header = [timeHeader(tail.unit), first.x.label ?? "", first.y.label ?? ""];
    return { header, columns: [tail.times, tail.xs, tail.ys] };
  }
  const lines = contents.flatMap((content) => marksOf(content, "line"));
  return lines.length === 0 ? null : linesTable(first.x, lines, names ?? lines.map(({ label }) => label));
}

function linesTable(x: PlotSide, lines: readonly CurveLine[], names: readonly string[]): Table {
  const [first] = lines as [CurveLine];
  if (x.along !== "time") {
    const place = x.along === null ? (x.label ?? "") : axisHeader(x.along, first.xs.length);
    return { header: [place, ...names], columns: [first.xs, ...lines.map(({ ys }) => ys)] };
  }
  const histories = lines.map(({ xs, ys }) => ({
    times: Array.from(xs),
    values: Array.from(ys) as number[],
  }));
  return { header: [timeHeader(x.unit ?? ""), ...names], columns: sideBySide(histories, -Infinity) };
}

function rasterTable({ x, y }: Content, raster: Raster): Table {
  if (raster.type !== "rows") {
    const axes = [x.along, y.along].filter((along): along is Axis => along !== null && along !== "time");
    const form = { axes, shape: [raster.nx, raster.ny], channels: raster.type === "picture" };
    return arrayTable(form, raster.values, raster.label) ?? { header: [], columns: [] };
  }
  const [time, side] = x.along === "time" ? [x, y] : [y, x];
  const { times, values } = raster.rows.within(time.range);
  const axis = side.along as Axis;
  return {
    header: [timeHeader(time.unit ?? ""), axisHeader(axis, raster.rows.width), raster.label],
    columns: plane(times, points(axis, raster.rows.width), values),
  };
}

export function arrayTable(
  { axes, shape, channels }: ArrayForm,
  values: Float32Array,
  name: string,
): Table | null {
  const [x, y] = axes;
  const [nx = 0, ny = 0] = shape;
  if (x === undefined) {
    return null;
  }
  const across = points(x, nx);
  if (y === undefined) {
    return { header: [axisHeader(x, nx), name], columns: [across, values] };
  }
  const header = [axisHeader(x, nx), axisHeader(y, ny)];
  if (!channels) {
    return { header: [...header, name], columns: plane(across, points(y, ny), values) };
  }
  const parts = CHANNELS.map((_, c) => values.filter((_, i) => i % CHANNELS.length === c));
  return {
    header: [...header, ...CHANNELS.map((channel) => `${name} ${channel}`)],
    columns: [...plane(across, points(y, ny), []).slice(0, 2), ...parts],
  };
}

// Columns of an array over two axes, one row for each of its values. C order: index = i * other.length + j.
export function plane(places: TableColumn, other: TableColumn, values: TableColumn): TableColumn[] {
  const one: (number | null)[] = [];
  const two: (number | null)[] = [];
  for (let i = 0; i < places.length; i++) {
    for (let j = 0; j < other.length; j++) {
      one.push(places[i] ?? null);
      two.push(other[j] ?? null);
    }
  }
  return [one, two, values];
}

// The name and unit of an axis; where the page has fewer values than samples, how many.
export function axisHeader(axis: Axis, count: number | undefined): string {
  const thinned = count !== undefined && count < axis.samples;
  return `${axisLabel(axis)}${thinned ? ` [thinned: ${count} values of ${axis.samples} samples]` : ""}`;
}

function timeHeader(unit: string): string {
  return unit === "" ? "time" : `time (${unit})`;
}

// Missing values are empty cells.
export function csv({ header, columns }: Table): string {
  const count = columns[0]?.length ?? 0;
  const lines = [header.map(quoted).join(",")];
  for (let i = 0; i < count; i++) {
    lines.push(columns.map((column) => cellText(column[i])).join(","));
  }
  return `${lines.join("\n")}\n`;
}

function cellText(value: number | null | undefined): string {
  return value == null || !Number.isFinite(value) ? "" : String(Number(value.toPrecision(9)));
}

function quoted(name: string): string {
  return /[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name;
}
