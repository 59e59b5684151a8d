/** The measurements, one function for each target. */
import type { Page } from "playwright-core";

import { many, selection } from "./documents";
import { median, quantile, show, showLoad } from "./figures";
import { smoothness, type Smoothness } from "./frames";
import { asScript, install } from "./probe";
import { slid } from "./slider";
import { slowed } from "./slowdown";
import { onStage, WIDE } from "./stage";

const SCRIPT = asScript(install);
const CONTEXTS = 5;
const SECONDS = 8;
/** Of each plot the canvas with its values: that of a map lies above the one with its axes. */
const PLOTS = ".plot-heat, .plot-host:not(:has(.plot-heat)) > .plot-canvas";

/** From the address to the first picture, each time with a new browser profile. */
export async function firstPaint(name: string, document: object | null, stands: string): Promise<void> {
  await onStage(document, async ({ open }) => {
    const first: number[] = [];
    const whole: number[] = [];
    for (let i = 0; i < CONTEXTS; i++) {
      const page = await open();
      await page.locator(stands).first().waitFor();
      whole.push(await page.evaluate(() => performance.now()));
      first.push(
        await page.evaluate(
          () => performance.getEntriesByName("first-contentful-paint")[0]?.startTime ?? NaN,
        ),
      );
      await page.context().close();
    }
    showLoad();
    show(`first paint of ${name}`, median(first) / 1000, "s", "< 1.5");
    show(`${name} is complete`, median(whole) / 1000, "s");
  });
}

/** From a key on a slider to the drawing of the field's response. */
export async function sliderToPlot(times: number): Promise<void> {
  await onStage(selection, async ({ open }) => {
    const page = await open(SCRIPT);
    await running(page);
    const all = await slid(page, "u", times);
    showLoad();
    show("slider to changed plot, median", median(all), "ms", "<= 60");
    show("slider to changed plot, 95 of 100 below", quantile(all, 0.95), "ms", "< 100");
  });
}

/** The plots of a document in real time. */
export async function manyPlots(name: string, document: object): Promise<void> {
  await onStage(document, async ({ open, browser }) => {
    const page = await open(SCRIPT);
    await running(page);
    await settled(page);
    const found = await smoothness(browser, page, SECONDS, PLOTS);
    showLoad();
    show(`${name} with a field of 200 x 200: pictures of the browser`, found.rate, "1/s", ">= 30");
    show(`${name}: the plot that is drawn least often`, found.least, "1/s", ">= 25");
    show(`${name}: time between pictures, 95 of 100 below`, found.p95, "ms", "<= 50");
    costs(name, found);
    show(
      `${name}: simulated time over real time`,
      await page.evaluate(() => window.probe.clock?.factor ?? NaN),
      "",
    );
  });
}

/** Many elements on the canvas, all boxes live: a still view, and a moved view. */
export async function manyElements(count: number): Promise<void> {
  await onStage(
    many(count),
    async ({ open, browser }) => {
      const page = await open(SCRIPT);
      await running(page);
      await settled(page);
      await panned(page, 4); // graphics in software compile at the first use
      await page.waitForTimeout(3000);
      const still = await smoothness(browser, page, SECONDS, ".graph-live canvas");
      showLoad();
      const shown = await page.locator(".graph-live").count();
      show(`${count} elements on the canvas: visible live boxes`, shown, "");
      show(`${count} elements with live boxes: time between pictures, 95 % below`, still.p95, "ms", "<= 50");
      show(`${count} elements: the live box that is drawn least often`, still.least, "1/s");
      costs(`${count} elements`, still);
      const [moved] = await Promise.all([
        smoothness(browser, page, SECONDS, ".none"),
        panned(page, SECONDS + 1),
      ]);
      show(`${count} elements, panning: time between pictures, 95 of 100 below`, moved.p95, "ms", "<= 50");
      costs(`${count} elements, panning`, moved);
      const [scaled] = await Promise.all([
        smoothness(browser, page, SECONDS, ".none"),
        zoomed(page, SECONDS + 1),
      ]);
      show(`${count} elements, panning: pictures of the browser`, moved.rate, "1/s", ">= 50");
      show(`${count} elements, zooming: pictures of the browser`, scaled.rate, "1/s", ">= 20");
    },
    WIDE,
  );
}

/** A real browser, connected to an engine that runs at full speed. */
export async function slowdown(rounds: number): Promise<void> {
  const { free, percent } = await slowed(rounds);
  showLoad();
  show("a free-running field of 101 samples, no browser watching", free, "steps/s");
  show("slowed by a real browser with four plots", percent, "%");
}

function costs(name: string, { script, renderer, gpu }: Smoothness): void {
  show(`${name}: script of the page for each picture`, script, "ms CPU");
  show(`${name}: process of the page for each picture`, renderer, "ms CPU");
  show(`${name}: process that puts pictures together, for each`, gpu, "ms CPU");
}

async function running(page: Page): Promise<void> {
  await page.getByRole("button", { name: /^Play/ }).click();
  await page.waitForFunction(() => window.probe.clock?.running === true);
}

/**
 * Wait until programs are compiled, plots are laid out, and the first garbage is collected. Where boxes are
 * too small for live pictures nothing is drawn.
 */
async function settled(page: Page): Promise<void> {
  await page.waitForFunction(
    () => window.probe.draws > 200 || document.querySelector(".plot-host, .graph-live") === null,
    undefined,
    { timeout: 120_000 },
  );
  await page.waitForTimeout(3000);
}

/** Drag the canvas for some seconds. */
export async function panned(page: Page, seconds: number): Promise<void> {
  const end = Date.now() + 1000 * seconds;
  await page.mouse.move(640, 300);
  await page.mouse.down();
  for (let i = 0; Date.now() < end; i++) {
    await page.mouse.move(640 + 200 * Math.sin(i / 12), 380 + 150 * Math.cos(i / 15));
  }
  await page.mouse.up();
}

/** Zoom the canvas in and out with the wheel for some seconds. */
export async function zoomed(page: Page, seconds: number): Promise<void> {
  const end = Date.now() + 1000 * seconds;
  await page.mouse.move(640, 380);
  for (let i = 0; Date.now() < end; i++) await page.mouse.wheel(0, i % 24 < 12 ? -60 : 60);
}
