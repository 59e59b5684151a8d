import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { box, button, drag, panel, reopen, select, slider, type } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

const kernel = [{ kind: "Gaussian", amplitude: 1.2, sigma: 5 }];
const field = { kind: "Field", kernel, global_inhibition: 0.4, noise: 0.1 };
const stimulus = { kind: "GaussianStimulus", center: 20, sigma: 5, amplitude: 8 };
const WEAK = {
  deodar: 2,
  name: "weak",
  axes: {
    x: { name: "x", lower: 0, upper: 100, samples: 101 },
    y: { name: "y", lower: 0, upper: 50, samples: 51 },
  },
  elements: {
    left: { ...stimulus, id: "00000001", axes: ["x"] },
    u: { ...field, id: "00000002", axes: ["x"] },
    below: { ...stimulus, id: "00000003", axes: ["y"] },
    strength: { kind: "Gain", id: "00000004", factor: 1 },
    "inner.v": { ...field, id: "00000005", axes: ["y"] },
  },
  connections: [
    { source: "left", target: "u" },
    { source: "below", target: "strength" },
    { source: "strength", target: "inner.v" },
  ],
  groups: ["inner"],
};

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({ files: { "weak.json": JSON.stringify(WEAK) }, file: "weak.json" });
  observer = await studio.observe();
});

beforeEach(async () => {
  await reopen(studio.page, observer, "weak.json");
  await studio.page.mouse.move(0, 0); // no card of an element covers a box
});

afterAll(() => studio.stop());

const inspected = (name: string) =>
  panel(studio.page, "Inspector").getByRole("heading", { name, exact: true });
const mark = (path: string, said: RegExp) => box(studio.page, path).getByRole("button", { name: said });
const shape = (of: ReturnType<typeof mark>) =>
  of.locator("svg path").evaluateAll((paths) => paths.map((path) => path.getAttribute("d")).join());

test("a warning appears and disappears on its box while a slider moves and the model runs", async () => {
  const { page } = studio;
  await select(page, "left");
  expect(
    await box(page, "u")
      .getByRole("button", { name: /^Warning|^Problem/ })
      .count(),
  ).toBe(0);
  await button(page, "Play").click();
  const thumb = slider(page, "amplitude");
  const [least, most] = await Promise.all(
    ["aria-valuemin", "aria-valuemax"].map(async (end) => Number(await thumb.getAttribute(end))),
  );
  await drag(page, thumb, (2 - (least as number)) / ((most as number) - (least as number)));
  const weak = mark("u", /^Warning: never reaches its threshold/);
  await weak.waitFor();
  expect(await weak.getAttribute("title")).toMatch(/make its inputs stronger than 5/);
  await button(page, "Pause").click();
  await shot(page, "marks-warning");
  await weak.focus();
  await page.keyboard.press("Enter");
  await inspected("u").waitFor();
  await panel(page, "Inspector").getByText("never reaches its threshold").waitFor();
  await select(page, "left");
  await type(page, "amplitude", "9");
  await weak.waitFor({ state: "detached" });
});

test("a problem has another shape than a warning, and is shown before it", async () => {
  const { page } = studio;
  await select(page, "left");
  await type(page, "amplitude", "3");
  const weak = mark("u", /^Warning: /);
  await weak.waitFor();
  const triangle = await shape(weak);
  await observer.ask({
    type: "set",
    element: observer.element("left").id,
    parameter: "sigma",
    value: [1, 2],
  });
  const wrong = mark("left", /^Problem: sigma has 2 values for 1 axes/);
  await wrong.waitFor();
  expect(await shape(wrong)).not.toBe(triangle);
  await shot(page, "marks-problem");
});

test("a folded group shows the marks of its elements; a coupling on an edge names its warning", async () => {
  const { page } = studio;
  await observer.ask({
    type: "set",
    element: observer.element("strength").id,
    parameter: "factor",
    value: 0.2,
  });
  await mark("inner.v", /^Warning: never reaches/).waitFor();
  await button(page, "Fold inner").click();
  await page.getByRole("img", { name: "A warning is in this group" }).waitFor();
  await shot(page, "marks-folded");
  await button(page, "Unfold inner").click();
  await observer.ask({
    type: "set",
    element: observer.element("strength").id,
    parameter: "factor",
    value: 0,
  });
  await page.getByRole("button", { name: /^strength, 0, Warning: |^strength, 0$/ }).waitFor();
});
