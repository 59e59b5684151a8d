import type { Locator } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";

import { box, colours } from "./hands";
import { shot, startStudio, type Studio } from "./studio";

const WIDE = { name: "x", lower: 0, upper: 9999, samples: 10_000 };
const SIDE = { name: "y", lower: 0, upper: 999, samples: 1000 };
const spot = (id: string, axes: string[], center: number | number[]) => ({
  kind: "GaussianStimulus",
  id,
  axes,
  center,
  sigma: axes.length > 1 ? [0.1, 0.1] : 0.1, // one sample
  amplitude: 5,
});
const panels = (of: [string, string][]) => ({
  grid: {
    width: 1280,
    height: 740,
    orientation: "VERTICAL",
    root: {
      type: "branch",
      size: 1280,
      data: ["graph", ...of.map(([id]) => `plot-${id}`)].map((id) => ({
        type: "leaf",
        size: 246,
        data: { id: `group-${id}`, views: [id], activeView: id },
      })),
    },
  },
  panels: Object.fromEntries([
    ["graph", { id: "graph", contentComponent: "graph", title: "Architecture" }],
    ...of.map(([element, kind]) => [
      `plot-${element}`,
      {
        id: `plot-${element}`,
        contentComponent: "plot",
        title: element,
        params: { element, kind, port: "output", settings: {} },
      },
    ]),
  ]),
});
const NARROW = {
  deodar: 1,
  name: "narrow",
  axes: { x: WIDE, y: SIDE, z: { ...SIDE, name: "z" } },
  elements: {
    line: spot("00000001", ["x"], 5003),
    plane: spot("00000002", ["y", "z"], [503, 701]),
  },
  connections: [],
  layout: {
    boxes: { "00000001": { x: 0, y: 0 }, "00000002": { x: 260, y: 0 } },
    panels: panels([
      ["00000001", "curve"],
      ["00000002", "heat"],
    ]),
  },
};

let studio: Studio;

beforeAll(async () => {
  studio = await startStudio({ files: { "narrow.json": JSON.stringify(NARROW) }, file: "narrow.json" });
  const observer = await studio.observe();
  await observer.runs();
  await observer.ask({ type: "step", n: 1 });
});

afterAll(() => studio.stop());

const plot = (name: string): Locator => studio.page.getByRole("region", { name, exact: true });

/** The share of a canvas's height that its coloured pixels span; lines and labels are grey. */
const span = (within: Locator): Promise<number> =>
  within.locator("canvas").evaluateAll((all) =>
    Math.max(
      ...all.map((element) => {
        const { width, height } = element as HTMLCanvasElement;
        const ctx = (element as HTMLCanvasElement).getContext("2d");
        const data = width === 0 ? [] : (ctx?.getImageData(0, 0, width, height).data ?? []);
        const rows: number[] = [];
        for (let i = 0; i < data.length; i += 4) {
          const [r = 0, g = 0, b = 0, a = 0] = [data[i], data[i + 1], data[i + 2], data[i + 3]];
          if (a > 128 && Math.max(r, g, b) - Math.min(r, g, b) > 80) rows.push(Math.floor(i / 4 / width));
        }
        return rows.length === 0 ? 0 : (rows.at(-1)! - rows[0]!) / height;
      }),
    ),
  );

test("a peak of one sample in 10,000 is seen in the plot and in the box", async () => {
  await expect.poll(() => span(box(studio.page, "line"))).toBeGreaterThan(0.6);
  await expect.poll(() => span(plot("Curves of line"))).toBeGreaterThan(0.4);
  await shot(studio.page, "narrow");
});

test("a peak of one sample of a plane of 1000 x 1000 is seen in the heat map and in the box", async () => {
  await expect.poll(() => colours(box(studio.page, "plane"))).toBeGreaterThan(1);
  await expect.poll(() => colours(plot("Heat map of plane"))).toBeGreaterThan(1);
});
