import { expect, test } from "vitest";
import { contract, type Contraction } from "./contract";
import { fakeCosivina, fakeKind, kindsOf } from "./fakes";
import { gridPlaces, isGrid, partsOf } from "./grid";
import { boxesOf, overlaps } from "../model/rects";

const KINDS = kindsOf(
  fakeKind("Field", "elements"),
  fakeKind("GaussianStimulus", "elements"),
  fakeKind("Noise", "elements"),
  fakeKind("Gain", "couplings"),
);
const SIZE = { width: 156, height: 104 };
const PANEL = { width: 960, height: 684 };

// Names with `!` receive stimuli.
const boxes = (...names: string[]) =>
  names.map((name) => ({ id: name.replace("!", ""), name: name.replace("!", ""), fed: name.endsWith("!") }));

function laid(file: string, panel = PANEL) {
  const document = fakeCosivina(file);
  const { boxes: ids, edges, dots } = contract(document, KINDS) as Contraction;
  const kinds = new Map(document.elements.map(({ id, kind }) => [id, kind]));
  const fed = (id: string) => (dots.get(id) ?? []).some((dot) => kinds.get(dot) === "GaussianStimulus");
  return gridPlaces(
    ids.map((id) => ({ id, name: id, fed: fed(id) })),
    edges,
    SIZE,
    panel,
  );
}

test("a name is split at its first underscore", () => {
  expect(["wm_c1", "cos", "a_b_c", "k_"].map(partsOf)).toEqual([
    { prefix: "wm", suffix: "c1" },
    { prefix: "cos", suffix: "" },
    { prefix: "a", suffix: "b_c" },
    { prefix: "k_", suffix: "" },
  ]);
});

test("twelve names of which half share both parts form a grid", () => {
  const names = ["a", "b", "c", "d"].flatMap((prefix) =>
    ["x", "y", "z"].map((suffix) => `${prefix}_${suffix}`),
  );
  expect(isGrid(names)).toBe(true);
  expect(isGrid(names.slice(1))).toBe(false);
  expect(isGrid([...names, ...Array.from({ length: 13 }, (_, i) => `n${i}`)])).toBe(false);
});

test.each(["presetSceneRepresentation.json", "presetLookingModel_old.json"])(
  "boxes of %s do not overlap",
  (file) => {
    const places = laid(file);
    expect(places.size).toBeGreaterThanOrEqual(12);
    expect(overlaps(boxesOf(places, SIZE))).toEqual([]);
  },
);

test("a prefix is a row, a suffix is a column, and a digit is a frame", () => {
  const places = laid("presetSceneRepresentation.json");
  const at = (name: string) => places.get(name) ?? { x: NaN, y: NaN };
  for (const [one, other] of [
    ["wm_c1", "wm_s"],
    ["atn_f1", "atn_sr"],
    ["con_f2", "con_s"],
  ] as const) {
    expect(at(one).y, one).toBe(at(other).y);
  }
  for (const [one, other] of [
    ["wm_c1", "atn_c1"],
    ["con_f2", "vis_f2"],
  ] as const) {
    expect(at(one).x, one).toBe(at(other).x);
  }
  const xs = (digit: string) => [...places].filter(([name]) => name.endsWith(digit)).map(([, { x }]) => x);
  expect(Math.max(...xs("1")) < Math.min(...xs("2")) || Math.max(...xs("2")) < Math.min(...xs("1"))).toBe(
    true,
  );
});

test("rows that receive stimuli are on top, alone", () => {
  const places = laid("presetSceneRepresentation.json");
  const rows = [...new Set([...places.values()].map(({ y }) => y))].sort((a, b) => a - b);
  const names = (y: number | undefined) =>
    [...places].flatMap(([name, place]) => (place.y === y ? [partsOf(name).prefix] : []));
  expect(rows).toHaveLength(5);
  expect(new Set([...names(rows[0]), ...names(rows[1])])).toEqual(new Set(["vis", "atn"]));
});

test("connected rows are neighbours", () => {
  const names = ["a", "b", "c"].flatMap((prefix) => ["x", "y", "z"].map((suffix) => `${prefix}_${suffix}`));
  const wires = ["x", "y", "z"].map((suffix) => ({ source: `a_${suffix}`, target: `c_${suffix}` }));
  const places = gridPlaces(boxes(...names), wires, SIZE, PANEL);
  const row = (name: string) => places.get(name)?.y ?? NaN;
  expect(row("c_x") - row("a_x")).toBe(
    row("b_x") > row("c_x") ? row("b_x") - row("c_x") : row("a_x") - row("b_x"),
  );
});

test("the grid takes the shape of the canvas", () => {
  const shape = (panel: typeof PANEL) => {
    const all = [...laid("presetSceneRepresentation.json", panel).values()];
    const [width, height] = [Math.max(...all.map(({ x }) => x)), Math.max(...all.map(({ y }) => y))];
    return (width + SIZE.width) / (height + SIZE.height);
  };
  expect(shape(PANEL)).toBeCloseTo(PANEL.width / PANEL.height, 1);
  expect(shape({ width: 1200, height: 500 })).toBeGreaterThan(1.9);
  expect(shape({ width: 390, height: 560 })).toBeLessThan(1.35);
});

test("the layout of the scene representation takes less than 100 ms of the processor", () => {
  laid("presetSceneRepresentation.json");
  const before = process.cpuUsage();
  laid("presetSceneRepresentation.json");
  const { user, system } = process.cpuUsage(before);
  expect((user + system) / 1000).toBeLessThan(100);
});

test("the search for an order ends, however many names there are", () => {
  const names = Array.from({ length: 100 }, (_, n) => [`u_${n}`, `v_${n}`]).flat();
  const wires = Array.from({ length: 100 }, (_, n) => ({ source: `u_${n}`, target: `v_${(7 * n) % 100}` }));
  const before = process.cpuUsage();
  const places = gridPlaces(boxes(...names), wires, SIZE, PANEL);
  const { user, system } = process.cpuUsage(before);
  expect((user + system) / 1000).toBeLessThan(1500);
  expect(new Set([...places.values()].map(({ x, y }) => `${x} ${y}`)).size).toBe(names.length);
});
