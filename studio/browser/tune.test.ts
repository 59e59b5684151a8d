import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import {
  button,
  choose,
  drag,
  number,
  openTool,
  panel,
  reopen,
  select,
  settled,
  slider,
  type,
} from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

const PLANE = {
  deodar: 1,
  name: "plane",
  axes: {
    x: { name: "x", lower: 0, upper: 10, samples: 11 },
    y: { name: "y", lower: 0, upper: 20, samples: 11 },
  },
  elements: {
    spot: { kind: "GaussianStimulus", id: "00000001", axes: ["x", "y"], center: 5, sigma: 2, amplitude: 1 },
  },
};

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({
    copies: ["examples/selection.json"],
    files: { "plane.json": JSON.stringify(PLANE) },
    file: "selection.json",
  });
  observer = await studio.observe();
});

// Each test opens the file on disk again.
beforeEach(async () => {
  await reopen(studio.page, observer, "selection.json");
  await select(studio.page, "u");
});

afterAll(() => studio.stop());

const inspector = () => panel(studio.page, "Inspector");
const group = (path: string) => inspector().getByRole("group", { name: path, exact: true });
const comes = (path: string, parameter: string, value: unknown) =>
  observer.until(() => JSON.stringify(observer.value(path, parameter)) === JSON.stringify(value));
const kinds = () => (observer.value("u", "kernel") as { kind: string }[]).map(({ kind }) => kind);
const shows = (path: string, text: string) =>
  expect.poll(() => number(studio.page, path).inputValue()).toBe(text);

/** Undo all edits, and redo them, by the keys. */
async function undoRedo(parameter: string, before: unknown, after: unknown): Promise<void> {
  await comes("u", parameter, after);
  await studio.page.keyboard.press("Control+z");
  await comes("u", parameter, before);
  await studio.page.keyboard.press("Control+Shift+z");
  await comes("u", parameter, after);
}

test("a number is dragged, stepped by keys and typed; it has a unit and a range", async () => {
  const { page } = studio;
  expect(await group("tau").innerText()).toContain("ms");
  expect(await group("kernel.0.sigma").innerText()).toContain("deg");
  const titles = await inspector().locator(".parameters h3").allInnerTexts();
  expect(titles).toEqual(["Time course", "Interaction", "Noise", "Axes"]);
  const thumb = slider(page, "resting_level");
  const [name, control] = [await group("tau").boundingBox(), await slider(page, "tau").boundingBox()];
  expect(name?.height, "a number has one line").toBeLessThan(36);
  expect(control?.y).toBeGreaterThan(name?.y ?? 0);
  expect([await thumb.getAttribute("aria-valuemin"), await thumb.getAttribute("aria-valuemax")]).toEqual([
    "-10",
    "10",
  ]);

  await drag(page, thumb, 0.75);
  // A pixel of the slider is 0.2 to 0.4.
  const dragged = Number(await number(page, "resting_level").inputValue());
  expect(Math.abs(dragged - 5)).toBeLessThan(0.5);
  await comes("u", "resting_level", dragged);
  expect(observer.document?.undo, "a drag is one step of undo").toBe(1);
  await undoRedo("resting_level", -5, dragged);

  await thumb.focus();
  await thumb.press("End");
  await comes("u", "resting_level", 10);
  await thumb.press("ArrowLeft");
  await comes("u", "resting_level", 9.9);
  await thumb.press("PageDown");
  await comes("u", "resting_level", 8.9);

  await type(page, "tau", "3e1");
  await comes("u", "tau", 30);
  await shows("tau", "30");
  await button(page, "Undo").click();
  await comes("u", "tau", 20);
  await button(page, "Redo").click();
  await comes("u", "tau", 30);
});

test("a drag on a number goes a hundredth of the range a pixel, with Shift a thousandth", async () => {
  const { page } = studio;
  const field = number(page, "resting_level");
  const by = async (pixels: number) => {
    const box = await settled(page, () => field.boundingBox());
    if (box === null) throw new Error("The number is not visible.");
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + pixels, y, { steps: 5 });
    await page.mouse.up();
  };
  await by(25);
  await comes("u", "resting_level", 0);
  expect(observer.document?.undo, "a drag is one step of undo").toBe(1);
  expect(await field.evaluate((input) => input === document.activeElement)).toBe(false);
  await page.keyboard.down("Shift");
  await by(-12);
  await page.keyboard.up("Shift");
  await comes("u", "resting_level", -0.24);
  await undoRedo("resting_level", 0, -0.24);
  await by(2);
  expect(await field.evaluate((input) => input === document.activeElement), "a click types").toBe(true);
  await page.keyboard.type("3");
  await page.keyboard.press("Enter");
  await comes("u", "resting_level", 3);
});

test("an invalid value shows the reason, changes nothing, and is restored", async () => {
  const { page } = studio;
  await type(page, "tau", "soon");
  await group("tau").getByText("needs a number, not soon").waitFor();
  await number(page, "tau").press("Escape");
  await shows("tau", "20");
  await group("tau").getByText("needs a number").waitFor({ state: "hidden" });

  await type(page, "tau", "-1");
  await group("tau").getByText("below its lower bound").waitFor();
  expect(await number(page, "tau").getAttribute("aria-invalid")).toBe("true");
  await number(page, "tau").press("Escape");
  await shows("tau", "20");
  expect(observer.value("u", "tau")).toBe(20);
  expect(observer.document?.unsaved).toBe(false);
});

test("another kind of sigmoid recompiles and keeps the state", async () => {
  const { page } = studio;
  await observer.ask({ type: "step", n: 300 });
  await observer.until(() => observer.clock?.tick === 300 && observer.max("u", "activation") > 1);
  const before = [...observer.values("u", "activation")];
  await inspector().getByRole("combobox", { name: "sigmoid", exact: true }).click();
  await page.getByRole("option", { name: "Linear", exact: true }).last().click();
  await observer.until(
    () =>
      (observer.value("u", "sigmoid") as { kind: string }).kind === "Linear" && observer.clock?.busy === "",
  );
  await observer.until(() => observer.values("u", "activation").length === before.length);
  expect([...observer.values("u", "activation")]).toEqual(before);
  expect(observer.clock?.tick).toBe(300);
  await group("sigmoid.beta").waitFor({ state: "detached" });
  await page.keyboard.press("Control+z");
  await group("sigmoid.beta").waitFor();
  await observer.until(() => (observer.value("u", "sigmoid") as { kind: string }).kind === "Logistic");
});

test("kernels are added, moved, replaced and removed", async () => {
  const { page } = studio;
  await choose(page, "Add to kernel", "Gaussian");
  await observer.until(() => kinds().length === 2);
  await type(page, "kernel.1.amplitude", "-3");
  await comes("u", "kernel.1.amplitude", -3);
  await choose(page, "More for kernel.1", "Move up");
  await comes("u", "kernel.0.amplitude", -3);
  await shows("kernel.1.amplitude", "12");
  await page.keyboard.press("Control+z");
  await comes("u", "kernel.1.amplitude", -3);
  await choose(page, "More for kernel.1", "Box");
  await observer.until(() => kinds().join() === "Gaussian,Box");
  await button(page, "Gaussian, kernel.0").click();
  await group("kernel.0.sigma").waitFor({ state: "detached" });
  await choose(page, "More for kernel.0", "Remove");
  await observer.until(() => kinds().join() === "Box");
  await observer.until(() => observer.clock?.busy === "");
});

test("a parameter has one number for all axes, or one for each", async () => {
  const { page } = studio;
  await reopen(page, observer, "plane.json");
  await select(page, "spot");
  await type(page, "sigma", "3");
  await comes("spot", "sigma", 3);
  await button(page, "sigma for each axis").click();
  await comes("spot", "sigma", [3, 3]);
  expect(await group("sigma.1").innerText()).toContain("y");
  await type(page, "sigma.1", "4");
  await comes("spot", "sigma", [3, 4]);
  await shot(page, "tune-per-axis");
  await button(page, "sigma for each axis").click();
  await comes("spot", "sigma", 3);
});

test("windows of a stimulus are added and removed", async () => {
  const { page } = studio;
  await select(page, "left");
  await type(page, "windows.0.start", "50");
  await comes("left", "windows.0.start", 50);
  await choose(page, "Add to windows", "Window");
  await observer.until(() => (observer.value("left", "windows") as unknown[]).length === 2);
  await choose(page, "More for windows.1", "Remove");
  await observer.until(() => (observer.value("left", "windows") as unknown[]).length === 1);
});

test("a stimulus without windows is never on, and always is a choice", async () => {
  const { page } = studio;
  await select(page, "left");
  const choice = page.getByRole("combobox", { name: "Choice of windows" });
  expect(await choice.inputValue()).toBe("as listed");
  await choose(page, "More for windows.0", "Remove");
  await comes("left", "windows", []);
  await expect.poll(() => choice.inputValue()).toBe("never");
  await choice.click();
  await page.getByRole("option", { name: "always" }).click();
  await comes("left", "windows", null);
  await expect.poll(() => choice.inputValue()).toBe("always");
  await shot(page, "tune-always");
  await choose(page, "Add to windows", "Window");
  await observer.until(() => (observer.value("left", "windows") as unknown[] | null)?.length === 1);
});

test("a parameter returns to its default", async () => {
  const { page } = studio;
  await group("noise").getByRole("img", { name: "not the default" }).waitFor();
  await choose(page, "More for noise", /^Reset to default/);
  await undoRedo("noise", 1, 0);
  await group("noise").getByRole("img", { name: "not the default" }).waitFor({ state: "detached" });
});

test("a parameter is pinned to the sliders, which are stored in the document", async () => {
  const { page, folder } = studio;
  await choose(page, "More for resting_level", "Pin to Sliders");
  await panel(page, "Sliders").waitFor();
  const pinned = slider(page, "u.resting_level", "Sliders");
  await pinned.waitFor();
  await drag(page, pinned, 0.5);
  await observer.until(() => Math.abs(observer.value("u", "resting_level") as number) < 0.2);
  await openTool(page, "Inspector");
  await choose(page, "More for kernel.0.sigma", "Pin to Sliders");
  await openTool(page, "Sliders");
  await type(page, "u.kernel.0.sigma", "6", "Sliders");
  await comes("u", "kernel.0.sigma", 6);
  await shot(page, "tune-pins");

  const original = readFileSync(join(folder, "selection.json"));
  await page.keyboard.press("Control+s");
  await observer.until(() => observer.document?.unsaved === false);
  const { layout } = JSON.parse(readFileSync(join(folder, "selection.json"), "utf8")) as {
    layout: { pins: { parameter: string }[] };
  };
  writeFileSync(join(folder, "selection.json"), original);
  expect(layout.pins.map(({ parameter }) => parameter)).toEqual(["resting_level", "kernel.0.sigma"]);
  await page.reload();
  await openTool(page, "Sliders");
  await pinned.waitFor();
  expect(await number(page, "u.kernel.0.sigma", "Sliders").inputValue()).toBe("6");
  await choose(page, "More for u.resting_level", "Unpin");
  await pinned.waitFor({ state: "detached" });
  await page.keyboard.press("Control+z");
  await pinned.waitFor();
});

test("one slider sets a document parameter that drives two elements", async () => {
  const { page } = studio;
  await select(page, "left");
  await choose(page, "More for amplitude", /^New document parameter/);
  await page.getByRole("textbox", { name: "Name of the document parameter" }).fill("strength");
  await button(page, "Create").click();
  await observer.until(() => observer.document?.parameters.length === 1);
  await select(page, "right");
  await choose(page, "More for amplitude", "strength");
  await observer.until(() => observer.document?.parameters[0]?.links.length === 2);

  await inspector().getByRole("button", { name: "Document", exact: true }).click();
  expect(
    await inspector().getByRole("list", { name: "Driven by strength" }).getByRole("listitem").allInnerTexts(),
  ).toEqual(["left.amplitude", "right.amplitude"]);
  await choose(page, "More for strength", "Pin to Sliders");
  await openTool(page, "Sliders");
  const strength = slider(page, "strength", "Sliders");
  await strength.focus();
  await strength.press("Home");
  const lowest = Number(await strength.getAttribute("aria-valuemin"));
  await observer.until(() => observer.document?.parameters[0]?.value === lowest);
  await type(page, "strength", "3", "Sliders");
  await comes("left", "amplitude", 3);
  await comes("right", "amplitude", 3);
  await button(page, "Undo").click();
  await comes("left", "amplitude", lowest);
  await comes("right", "amplitude", lowest);
});
