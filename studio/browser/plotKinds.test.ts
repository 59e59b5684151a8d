import { readFileSync } from "node:fs";

import type { Locator } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";

import { obstacles } from "./axe";
import { PLOTS } from "../src/plots/kinds/plots";
import { SHOWN, writeArranged, writeEveryPlot } from "./everyPlot";
import { button, colours, downloaded, drawn, panel, reopen, settled, showView } from "./hands";
import { examplePackage } from "./installed";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio(examplePackage());
  // twelve plots are seen at once in Run
  await studio.page.setViewportSize({ width: 1600, height: 1000 });
  await writeEveryPlot(studio.folder);
  observer = await studio.observe();
});

afterAll(() => studio.stop());

const plot = (name: string): Locator => studio.page.getByRole("region", { name, exact: true });

/** Open `every.json` with these plots, and compute some steps. */
async function arrange(name: string, rows: Parameters<typeof writeArranged>[2]): Promise<void> {
  writeArranged(studio.folder, name, rows);
  await reopen(studio.page, observer, name);
  await showView(studio.page, "Run");
  // every plot has a first sample before the others are computed: a time course begins with the first one
  // after its subscription, and a phase plot needs two
  for (const [n, tick] of [
    [1, 1],
    [299, 300],
  ]) {
    await observer.ask({ type: "step", n });
    await observer.until(() => observer.clock?.tick === tick);
    await expect.poll(() => studio.page.getByText("Press play").count()).toBe(0);
  }
}

/** Move the pointer to a share of the width and height of a drawing. */
async function point(at: Locator, across: number, down: number): Promise<void> {
  const room = await settled(studio.page, () => at.boundingBox());
  if (room === null) throw new Error("The plot is not visible.");
  await at.hover({ position: { x: room.width * across, y: room.height * down } });
}

/** The values at the cursor of a plot: words, then numbers. */
async function reading(name: string): Promise<string> {
  const text = (await plot(name).locator(".plot-readout").textContent()) ?? "";
  return text.replace(/\s+/g, " ").replaceAll("\u2212", "-");
}

test("fixed weights are a heat map over target and source, opened beside their parameter", async () => {
  const { page } = studio;
  await reopen(page, observer, "every.json");
  await page.keyboard.press("Control+f");
  await page.getByRole("combobox", { name: "Search for an element" }).fill("map");
  await page.keyboard.press("Enter");
  await panel(page, "Inspector").getByRole("button", { name: "Plot weights" }).click();
  const map = plot("Weights of map");
  await map.getByRole("img", { name: "weights of map as colours over x and y" }).waitFor();
  await expect.poll(() => colours(map.locator("canvas.plot-heat"))).toBeGreaterThan(20);
  // the rows of a picture of the document are over y, which therefore runs downwards
  await point(map.locator(".plot-over"), 0.99, 0.02);
  await expect.poll(() => reading("Weights of map")).toMatch(/^x 20\.\d* y -0\.\d* 20\.\d*$/);
  await shot(page, "plot-weights");
  await point(map.locator(".plot-over"), 0.01, 0.98);
  await expect.poll(() => reading("Weights of map")).toMatch(/^x -0\.\d* y 10\.\d* -20\.\d*$/);
});

test("the kernel of a field over two axes is a heat map over both lags", async () => {
  const { page } = studio;
  await arrange("kernel.json", [[["plane", "kernel"]]]);
  const kernel = plot("Interaction kernel of plane");
  await expect.poll(() => colours(kernel.locator("canvas.plot-heat"))).toBeGreaterThan(10);
  await point(kernel.locator(".plot-over"), 0.5, 0.5);
  // 8 / (2 pi 2^2), the amplitude is the integral
  await expect
    .poll(() => reading("Interaction kernel of plane"))
    .toMatch(/^lag in x .* lag in y .* 0\.3\d\d$/);
  const before = await drawn(kernel.locator("canvas.plot-heat"));
  const [element, parameter] = [observer.element("plane").id, "kernel.0.sigma"];
  await observer.ask({ type: "set", element, parameter, value: 4 });
  await expect.poll(() => drawn(kernel.locator("canvas.plot-heat"))).not.toBe(before);
  await expect.poll(() => reading("Interaction kernel of plane")).toMatch(/ 0\.080$/);
  await shot(page, "plot-kernel-plane");
});

test("the cursor is linked among maps, pictures, scenes and multiples, not to a kernel's lags", async () => {
  await arrange("cursor.json", [
    [
      ["line", "curve"],
      ["flat", "heat"],
      ["picture", "picture"],
      ["map", "weights"],
    ],
    [
      ["flat", "surface"],
      ["volume", "volume"],
      ["plane", "multiples"],
      ["line", "kernel"],
    ],
    [
      ["node", "course"],
      ["node", "phase"],
    ],
  ]);
  const [heat, surface, volume] = ["Heat map of flat", "Surface of flat", "Volume slices of volume"];
  const expectReading = (name: string, words: RegExp) =>
    expect.poll(() => reading(name), { message: name }).toMatch(words);
  for (const name of [surface, volume]) await plot(name).locator("canvas.plot-scene[aria-label]").waitFor();
  await point(plot("Curves of line").locator(".plot-over"), 0.5, 0.5);
  for (const name of [heat, surface, volume, "Weights of map"])
    await expectReading(name, /^x (9|10)\.\d* max -?\d/);
  await expectReading("Picture of picture", /^x (9|10)\.\d*$/);
  const cells = plot("Small multiples of plane").locator(".plot-readout");
  await expect.poll(() => cells.allTextContents()).toHaveLength(2);
  for (const text of await cells.allTextContents()) expect(text).toMatch(/^x\s(9|10)\.\d*\s+max/);
  for (const name of ["Interaction kernel of line", "Phase plot of node"])
    expect(await reading(name), name).toBe("");
  expect(await obstacles(studio.page)).toEqual([]);
  await shot(studio.page, "plot-linked-scenes");

  await point(plot(heat).locator(".plot-over"), 0.25, 0.75);
  for (const name of [surface, volume]) await expectReading(name, /^x 4\.\d* y 7\.\d* -?\d/);
  await expectReading("Picture of picture", /^x 4\.\d* y 7\.\d* r 0\.2\d* g 0\.[78]\d* b 0/);
  expect(await reading(surface), "the same value in both").toBe(await reading(heat));

  for (const name of [surface, volume]) {
    await point(plot(name).getByRole("group", { name: /arrow keys turn/ }), 0.5, 0.55);
    await expectReading(name, /^[xyz] .*\d$/);
    await expectReading(heat, /^[xy] .*\d$/);
  }
  await point(plot(surface).getByRole("group", { name: /arrow keys turn/ }), 0.45, 0.5);
  await expectReading(surface, /^x \S+ y \S+ \d+/);
  await expect.poll(async () => (await reading(heat)) === (await reading(surface))).toBe(true);
  await expectReading("Curves of line", /^x /);

  await point(plot("Time course of node").locator(".plot-over"), 0.05, 0.5);
  await expectReading("Phase plot of node", /^t \d/);
  await expectReading(surface, /^$/);
});

test("a field over four axes is cut by sliders on the axes that are not drawn", async () => {
  await arrange("four.json", [
    [
      ["four", "heat"],
      ["four", "volume"],
    ],
  ]);
  const [heat, volume] = ["Heat map of four", "Volume slices of four"];
  const slide = (name: string, axis: string, key: string) =>
    plot(name)
      .getByRole("slider", { name: `Position on ${axis}` })
      .press(key);
  expect(await plot(heat).getByRole("slider").count()).toBe(2);
  expect(await plot(volume).getByRole("slider").count()).toBe(4);
  const value = async (name: string) => Number((await reading(name)).split(" ").at(-1));
  await point(plot(heat).locator(".plot-over"), 0.01, 0.5);
  // 100 w + 10 z + x / 100
  await expect.poll(() => value(heat)).toBe(350);
  await slide(heat, "z", "Home");
  await expect.poll(() => value(heat)).toBe(300);
  await slide(heat, "w", "Home");
  await expect.poll(() => value(heat)).toBe(0);
  await slide(heat, "z", "End");
  await expect.poll(() => value(heat)).toBe(50);

  await point(plot(volume).getByRole("group", { name: /arrow keys turn/ }), 0.5, 0.5);
  await expect.poll(() => value(volume)).toBeGreaterThanOrEqual(300);
  await slide(volume, "w", "Home");
  await expect.poll(() => value(volume)).toBeLessThan(100);
  await slide(volume, "w", "ArrowRight");
  await expect.poll(async () => Math.floor((await value(volume)) / 100)).toBe(1);
  await shot(studio.page, "plot-four-axes");
});

test("plots without a scene ask the server for no further part of the page", async () => {
  await observer.ask({ type: "close", discard: true });
  const page = await studio.another();
  await page.getByRole("heading", { name: "Examples" }).waitFor();
  const asked: string[] = [];
  page.on("request", (request) => {
    if (/assets.*\.js$/.test(request.url())) asked.push(request.url());
  });
  const flat = Object.entries(SHOWN).filter(([kind]) => !["surface", "volume", "polar"].includes(kind));
  const rows = flat.map(([kind, [element]]) => [element, kind] as const);
  writeArranged(studio.folder, "flat.json", [rows.slice(0, 3), rows.slice(3, 6), rows.slice(6)]);
  await reopen(page, observer, "flat.json");
  for (const [element, kind] of rows)
    await page.locator(`section[aria-label="${PLOTS.get(kind)?.title} of ${element}"]`).waitFor();
  expect(asked).toEqual([]);
  await page.close();
});

/** Every kind of plot, side by side. */
function arrangeAll(name: string): Promise<void> {
  const all = Object.entries(SHOWN).map(([kind, [element]]) => [element, kind] as const);
  return arrange(name, [all.slice(0, 4), all.slice(4, 8), all.slice(8)]);
}

test("a run continues from a moment with every kind of plot open, and all follow", async () => {
  const { page } = studio;
  await arrangeAll("past.json");
  const moment = page.getByRole("status", { name: "Moment shown" });
  await button(page, "First frame").click();
  await expect.poll(() => moment.innerText()).toMatch(/^0 ms/);
  await observer.ask({ type: "speed", factor: 0.01 });
  await button(page, "Run from here").click();
  await observer.until(() => observer.running && observer.time < 300);
  await button(page, "Pause").click();
  await observer.until(() => !observer.running);
  await observer.ask({ type: "step", n: 300 - observer.time });
  await observer.until(() => observer.clock?.tick === 300);
  expect(await page.getByRole("alert").count()).toBe(0);
  for (const [kind, [element, header]] of Object.entries(SHOWN)) {
    const name = `${PLOTS.get(kind)?.title ?? "Polar plot"} of ${element}`;
    await plot(name).getByRole("button", { name: "Menu of this plot" }).click();
    const item = page.getByRole("menuitem", { name: "Export CSV" });
    const lines = readFileSync(await (await downloaded(page, () => item.click())).path(), "utf8").split("\n");
    await page.getByRole("menu").waitFor({ state: "detached" });
    expect(lines[0], name).toBe(header);
    expect(lines.length, name).toBeGreaterThan(20);
  }
  await observer.ask({ type: "speed", factor: 1 });
});

test("every kind of plot is exported as PNG, SVG and CSV", async () => {
  const { page } = studio;
  expect(new Set([...PLOTS.keys(), "polar"])).toEqual(new Set(Object.keys(SHOWN)));
  await arrangeAll("export.json");
  for (const [kind, [element, header]] of Object.entries(SHOWN)) {
    const name = `${PLOTS.get(kind)?.title ?? "Polar plot"} of ${element}`;
    const files: Record<string, Buffer> = {};
    for (const format of ["PNG", "SVG", "CSV"]) {
      const item = page.getByRole("menuitem", { name: `Export ${format}` });
      await plot(name).getByRole("button", { name: "Menu of this plot" }).click();
      const file = await downloaded(page, () => item.click());
      files[format] = readFileSync(await file.path());
      await page.getByRole("menu").waitFor({ state: "detached" });
    }
    expect(files["PNG"]?.subarray(1, 4).toString(), name).toBe("PNG");
    expect(files["PNG"]?.length, name).toBeGreaterThan(1000);
    expect(files["SVG"]?.toString(), name).toMatch(/^<svg .*<(path|image|text).*<\/svg>\s*$/s);
    const lines = files["CSV"]?.toString().trimEnd().split("\n") ?? [];
    expect(lines[0], name).toBe(header);
    expect(lines.length, name).toBeGreaterThan(20);
    expect(lines[1], name).toMatch(/\d,.*\d$/);
  }
});
