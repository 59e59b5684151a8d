// Files that the page writes to the folder of downloads.

import { csv, type Table } from "../draw/table";

export function saveTable(title: string, table: Table): void {
  saveFile(new Blob([csv(table)], { type: "text/csv" }), title, "csv");
}

export function saveFile(blob: Blob, title: string, suffix: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = `${title.replace(/[^\p{L}\p{N}]+/gu, "_").replace(/^_+|_+$/g, "") || "plot"}.${suffix}`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
