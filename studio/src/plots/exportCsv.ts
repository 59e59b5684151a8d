// The values of a plot as a CSV file: one row for each position, or moment, with the names and units of axes.

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

function cellText(value: number | null | undefined): string {
  return value == null || !Number.isFinite(value) ? "" : String(Number(value.toPrecision(9)));
}

function quoted(name: string): string {
  return /[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name;
}
