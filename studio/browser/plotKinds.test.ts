import type { Locator } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";

import { writeArranged, writeEveryPlot } from "./everyPlot";
import { colours, drawn, panel, reopen, settled } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio();
  writeEveryPlot(studio.folder);
  observer = await studio.observe();
});

afterAll(() => studio.stop());

const plot = (name: string): Locator => studio.page.getByRole("region", { name, exact: true });

/** Open `every.json` with these plots, and compute some steps. */
async function arrange(name: string, rows: Parameters<typeof writeArranged>[2]): Promise<void> {
  writeArranged(studio.folder, name, rows);
  await reopen(studio.page, observer, name);
  await observer.ask({ type: "step", n: 20 });
  await observer.until(() => observer.clock?.tick === 20);
  await expect.poll(() => studio.page.getByText("Press play").count()).toBe(0);
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
  await page.getByRole("textbox", { name: "Search for an element" }).fill("map");
  await page.keyboard.press("Enter");
  await panel(page, "Inspector").getByRole("button", { name: "Plot weights" }).click();
  const map = plot("Weights of map");
  await map.getByRole("img", { name: "weights of map as colours over x and y" }).waitFor();
  await expect.poll(() => colours(map.locator("canvas.plot-heat"))).toBeGreaterThan(20);
  // the rows of a picture of the document are over y, which therefore runs downwards
  await point(map.locator(".u-over"), 0.99, 0.02);
  await expect.poll(() => reading("Weights of map")).toMatch(/^x 20\.\d* y -0\.\d* 20\.\d*$/);
  await shot(page, "plot-weights");
  await point(map.locator(".u-over"), 0.01, 0.98);
  await expect.poll(() => reading("Weights of map")).toMatch(/^x -0\.\d* y 10\.\d* -20\.\d*$/);
});

test("the kernel of a field over two axes is a heat map over both lags", async () => {
  const { page } = studio;
  await arrange("kernel.json", [[["plane", "kernel"]]]);
  const kernel = plot("Interaction kernel of plane");
  await expect.poll(() => colours(kernel.locator("canvas.plot-heat"))).toBeGreaterThan(10);
  await point(kernel.locator(".u-over"), 0.5, 0.5);
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
