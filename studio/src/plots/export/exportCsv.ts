// The values of a plot as a CSV file: one row for each position, or moment, with the names and units of axes.

import type { Announced, AxisView } from "../../protocol";
import { axisLabel, points } from "../../model/axes";
import { type TableColumn, saveFile } from "./save";

export type Table = { header: string[]; columns: TableColumn[] };

export function exportCsv(title: string, table: Table): void {
  saveFile(new Blob([csv(table)], { type: "text/csv" }), title, "csv");
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

// An array over two axes, one row for each of its values. C order: index = i * other.length + j.
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

// The values of a stream over one axis, over two, or over two with the channels of a picture.
export function arrayTable(form: Announced, values: Float32Array, name: string): Table | null {
  const [x, y] = form.axes;
  const [nx = 0, ny = 0] = form.shape;
  if (x === undefined) {
    return null;
  }
  const across = points(x, nx);
  if (y === undefined) {
    return { header: [axisHeader(x, nx), name], columns: [across, values] };
  }
  const header = [axisHeader(x, nx), axisHeader(y, ny)];
  if (!form.channels) {
    return { header: [...header, name], columns: plane(across, points(y, ny), values) };
  }
  const channels = CHANNELS.map((_, c) => values.filter((_, i) => i % CHANNELS.length === c));
  return {
    header: [...header, ...CHANNELS.map((channel) => `${name} ${channel}`)],
    columns: [...plane(across, points(y, ny), []).slice(0, 2), ...channels],
  };
}

const CHANNELS = ["red", "green", "blue"];

// The name and unit of an axis; where the page has fewer values than samples, how many.
export function axisHeader(axis: AxisView, count: number | undefined): string {
  const thinned = count !== undefined && count < axis.samples;
  return `${axisLabel(axis)}${thinned ? ` [thinned: ${count} values of ${axis.samples} samples]` : ""}`;
}

function cellText(value: number | null | undefined): string {
  return value == null || !Number.isFinite(value) ? "" : String(Number(value.toPrecision(9)));
}

function quoted(name: string): string {
  return /[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name;
}
