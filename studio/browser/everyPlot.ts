import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { panels } from "./bench/documents";
import { runScript } from "./server";

/** Each kind of plot: an element of `every.json`, and the first line of its table. */
export const SHOWN: Record<string, [element: string, header: string]> = {
  course: ["node", "time (ms),activation"],
  curve: ["far", "long [thinned: 600 values of 1000 samples],output"],
  heat: ["plane", "x (cm),y (cm),activation"],
  picture: ["picture", "x (cm),y (cm),output red,output green,output blue"],
  space_time: ["line", "time (ms),x (cm),activation"],
  phase: ["node", "time (ms),activation,rate of change (1/ms)"],
  surface: ["flat", "x (cm),y (cm),output"],
  volume: ["volume", "x (cm),y (cm),z (cm),activation"],
  kernel: ["line", "lag in x (cm),weight"],
  weights: ["map", "x (cm),y (cm),weights"],
  multiples: ["plane", "x (cm),y (cm),plane,fellow"],
  polar: ["ring", "angle (deg),activation"],
};

type Shown = readonly [element: string, kind: string, settings?: object];

/** Write `every.json` and the file of its arrays into a folder. */
export async function writeEveryPlot(folder: string): Promise<void> {
  await runScript("every_plot", folder);
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
