import { readFileSync } from "node:fs";
import { join } from "node:path";

import { expect, test } from "vitest";

import type { DocumentView } from "../protocol";
import { firstTiles } from "./firstTiles";

const elements = [
  {
    id: "1",
    path: "u",
    name: "u",
    kind: "Field",
    outputs: ["activation", "output"],
    inputs: ["input"],
    axes: [],
  },
  { id: "2", path: "k", name: "k", kind: "Field", outputs: ["output"], inputs: ["input"], axes: [] },
];
const document = (layout: object) => ({ elements, axes: [], layout }) as unknown as DocumentView;
const opened = (layout: object) => firstTiles(document(layout), new Map());
const named = (layout: object) => opened(layout).build?.map(({ element, port }) => [element, port]);

test("the plots of a layout are listed in their order, and invalid entries are skipped", () => {
  const plots = [
    { element: "2", port: "output" },
    null,
    3,
    { element: "9", port: "output" },
    { element: "1", port: "colour" },
    { element: "1" },
    { element: "1", port: "activation" },
  ];
  const listed = [
    ["2", "output"],
    ["1", "activation"],
  ];
  expect(named({ plots })).toEqual(listed);
  expect(named({ plots, panels: { grid: 1 } }), "an arrangement that is none").toEqual(listed);
});

test("of panels that earlier versions stored, the plots become tiles in their order", () => {
  const plot = (element: string) => ({
    id: `plot-${element}`,
    contentComponent: "plot",
    params: { element, kind: "curve", port: "output", settings: { range: [0, 1] } },
  });
  const panels = {
    "plot-2": plot("2"),
    graph: { id: "graph", contentComponent: "graph" },
    "plot-1": plot("1"),
  };
  const { build } = opened({ panels: { grid: {}, panels } });
  expect(build?.map(({ element, kind }) => [element, kind])).toEqual([
    ["2", "curve"],
    ["1", "curve"],
  ]);
  expect(build?.[0]?.settings).toEqual({ range: [0, 1] });
  expect(named({ panels: { grid: {}, panels: { graph: panels.graph } } }), "no plot was open").toEqual([]);
});

test.each([
  ["pointing", ["perceptual", "cues"]],
  ["looking", ["events", "perceptual", "visual intention", "motor intention", "pan map", "tilt map"]],
  ["color_search", ["weights", "nodes", "action"]],
])("the example %s of an earlier version opens with its plots", (name, plots) => {
  const folder = join(import.meta.dirname, "..", "..", "..", "examples");
  const { layout } = JSON.parse(readFileSync(join(folder, `${name}.json`), "utf8"));
  expect(Object.keys(layout.panels.panels).filter((id) => plots.includes(id))).toEqual(plots);
  expect(opened(layout).build).toHaveLength(plots.length);
});

test("tiles are stored for each view, and come before everything else", () => {
  const tile = (element: string) => ({ element, kind: "heat", port: "output", settings: {} });
  const tiles = { build: [tile("1")], run: [tile("2"), tile("1"), 3, { element: 3 }], other: [tile("1")] };
  const views = opened({ tiles, plots: [{ element: "2", port: "output" }] });
  expect(views).toEqual({ build: [tile("1")], run: [tile("2"), tile("1")] });
  expect(opened({ tiles: { build: [] } })).toEqual({ build: [] });
});
