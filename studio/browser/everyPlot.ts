import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { panels } from "./bench/documents";
import { runScript } from "./server";

type Shown = readonly [element: string, kind: string, settings?: object];

/** Write `every.json` and the file of its arrays into a folder. */
export function writeEveryPlot(folder: string): void {
  runScript("every_plot", folder);
}

/** Write a copy of `every.json` with these plots side by side, in rows. */
export function writeArranged(folder: string, name: string, rows: Shown[][]): void {
  const document = JSON.parse(readFileSync(join(folder, "every.json"), "utf8"));
  const port = (element: string) =>
    ["Pattern", "Weights"].includes(document.elements[element].kind) ? "output" : "activation";
  const shown = rows.map((row) =>
    row.map(([element, kind, settings = {}]) => ({
      element: document.elements[element].id as string,
      kind,
      port: port(element),
      settings,
    })),
  );
  writeFileSync(join(folder, name), JSON.stringify({ ...document, layout: { panels: panels(shown) } }));
}
