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
const document = (layout: object) =>
  ({ elements, axes: [], layout: { tiles: null, plots: [], ...layout } }) as unknown as DocumentView;
const opened = (layout: object) => firstTiles(document(layout), new Map());
const named = (layout: object) => opened(layout).build?.map(({ element, port }) => [element, port]);

test("the plots of a layout are listed in their order, those of other documents are skipped", () => {
  const plots = [
    { element: "2", port: "output" },
    { element: "9", port: "output" },
    { element: "1", port: "colour" },
    { element: "1", port: "activation" },
  ];
  const listed = [
    ["2", "output"],
    ["1", "activation"],
  ];
  expect(named({ plots })).toEqual(listed);
});

test("tiles are stored for each view, and come before everything else", () => {
  const tile = (element: string) => ({ element, kind: "heat", port: "output", settings: {} });
  const tiles = { build: [tile("1")], run: [tile("2"), tile("1")] };
  expect(opened({ tiles, plots: [{ element: "2", port: "output" }] })).toEqual(tiles);
  expect(opened({ tiles: { build: [] } })).toEqual({ build: [] });
});
