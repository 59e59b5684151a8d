import { expect, test } from "vitest";
import { CHIP } from "./contracted";
import { fakeCosivina, fakeKind, fakeLayout, kindsOf } from "./fakes";
import { nearOf } from "../actions/focus";
import { partsOf } from "./grid";
import { PANEL } from "./layout";
import { scene } from "./scene";
import { withCourses } from "./courses";

const KINDS = kindsOf(
  fakeKind("Field", "elements"),
  fakeKind("GaussianStimulus", "elements"),
  fakeKind("Noise", "elements", { equation: ["\\xi"] }),
  fakeKind("Gain", "couplings"),
);
const DOCUMENT = fakeCosivina("presetSceneRepresentation.json");
const SCENE = scene(DOCUMENT, KINDS, PANEL);

test("every element is a box, or a box or a wire reveals it", () => {
  const shown = new Set([...SCENE.nodes.map(({ id }) => id), ...SCENE.pills.keys(), ...SCENE.holders.keys()]);
  expect(DOCUMENT.elements.filter(({ id }) => !shown.has(id))).toEqual([]);
  expect(SCENE.nodes).toHaveLength(20);
});

test("each coupling is revealed by one wire, and wires with couplings have room for a chip", () => {
  const revealed = SCENE.wires.flatMap(({ data }) => data?.revealed ?? []);
  expect(new Set(revealed).size).toBe(revealed.length);
  expect(SCENE.wires.every(({ data }) => data?.room === (data?.pills.length === 0 ? 0 : CHIP))).toBe(true);
  expect(SCENE.wires.every(({ data }) => data?.content !== null)).toBe(true);
});

test("all wires are led", () => {
  expect(withCourses(SCENE).filter(({ data }) => data?.course === null)).toEqual([]);
});

test("near a box are those that a wire joins with it; near a coupling and a stimulus, their boxes", () => {
  const near = (id: string) => nearOf(SCENE.links ?? new Map(), [id]);
  expect(near("cos").has("pd_c1")).toBe(true);
  expect(near("cos").has("vis_f1")).toBe(false);
  expect(near("atn_sr -> ior_s")).toEqual(new Set(["atn_sr -> ior_s", "atn_sr", "ior_s"]));
  expect(near("i1 for vis_f1").has("vis_f1")).toBe(true);
});

test("stored positions are kept, and where most boxes have one there is no grid for the others", () => {
  const at = (id: string, boxes: Record<string, { x: number; y: number }>) =>
    scene({ ...DOCUMENT, layout: fakeLayout({ boxes }) }, KINDS, PANEL).places.elements.get(id);
  const grid = SCENE.places.elements.get("cos");
  expect(at("wm_s", { wm_s: { x: 5000, y: 7 } })).toEqual({ x: 5000, y: 7 });
  expect(at("cos", { wm_s: { x: 5000, y: 7 } })).toBeDefined();
  const placed = Object.fromEntries([...SCENE.places.elements].filter(([id]) => id !== "cos"));
  expect(at("wm_s", placed)).toEqual(SCENE.places.elements.get("wm_s"));
  expect(at("cos", placed)).not.toEqual(grid);
});

test("the columns of one digit have a frame, until a box is moved across it", () => {
  expect(SCENE.frames.map(({ name }) => name.split(" ").sort().join(" ")).sort()).toEqual([
    "c1 f1",
    "c2 f2",
    "s sa sr",
  ]);
  for (const { id, name } of DOCUMENT.elements) {
    const at = SCENE.places.elements.get(id);
    const around = SCENE.frames.find((frame) => frame.name.split(" ").includes(partsOf(name).suffix));
    if (at === undefined || around === undefined) continue;
    expect([around.x < at.x, at.x + 156 < around.x + around.width, around.y < at.y], name).toEqual([
      true,
      true,
      true,
    ]);
  }
  const { x, y } = SCENE.places.elements.get("wm_f2") ?? { x: NaN, y: NaN };
  const moved = { ...Object.fromEntries(SCENE.places.elements), wm_f1: { x, y: y + 130 } };
  expect(scene({ ...DOCUMENT, layout: fakeLayout({ boxes: moved }) }, KINDS, PANEL).frames).toEqual([]);
});

test("small documents have no links, and their boxes show no other elements", () => {
  const small = scene(fakeCosivina("presetThreeLayerField_spRecall_adult.json"), KINDS);
  expect(small.links).toBeNull();
  expect(small.holders.size).toBe(0);
});

test("pinned sliders change no cell of the grid", () => {
  const pins = SCENE.nodes.slice(0, 2).map(({ id }) => ({ element: id, parameter: "tau" }));
  expect(scene({ ...DOCUMENT, layout: fakeLayout({ pins }) }, KINDS, PANEL).nodes).toEqual(SCENE.nodes);
});
