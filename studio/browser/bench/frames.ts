/** The frame rate of a page, and its processor time. */
import type { Browser, Page } from "playwright-core";

import "./probe";
import { quantile } from "./figures";

export interface Smoothness {
  /** Frames of the browser per second. */
  rate: number;
  /** The 95th percentile of the time between two frames, in ms. */
  p95: number;
  /** Drawings per second of the canvas that was drawn least; 0 without canvases. */
  least: number;
  /**
   * Processor time per frame in ms: the page's own script, the whole process of the page, and the
   * process that composes frames.
   */
  script: number;
  renderer: number;
  gpu: number;
}

/**
 * Frames of a page during a gesture: their rate, and the processor time in ms that the main thread of the
 * page spends on each. That time hardly depends on what else the machine does.
 */
export async function mainThread(
  page: Page,
  gesture: () => Promise<void>,
): Promise<{ rate: number; cpu: number }> {
  const count = await page.evaluateHandle(() => {
    const count = { frames: 0, going: true };
    const next = () => {
      count.frames += 1;
      if (count.going) requestAnimationFrame(next);
    };
    requestAnimationFrame(next);
    return count;
  });
  const from = performance.now();
  const spent = await threadTime(page, gesture);
  const seconds = (performance.now() - from) / 1000;
  const frames = await count.evaluate((found) => {
    found.going = false;
    return found.frames;
  });
  return { rate: frames / seconds, cpu: spent / frames };
}

/** The processor time in ms that the main thread of a page spends on a gesture. */
export const threadTime = (page: Page, gesture: () => Promise<unknown>): Promise<number> =>
  spentOn(page, gesture, ["TaskDuration"]);

/** The same without painting, whose time depends on the graphics card: scripts, styles and layout. */
export const scriptTime = (page: Page, gesture: () => Promise<unknown>): Promise<number> =>
  spentOn(page, gesture, ["ScriptDuration", "RecalcStyleDuration", "LayoutDuration"]);

async function spentOn(page: Page, gesture: () => Promise<unknown>, kinds: string[]): Promise<number> {
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable", { timeDomain: "threadTicks" });
  const sum = async () => {
    const { metrics } = await session.send("Performance.getMetrics");
    return metrics.reduce((total, { name, value }) => total + (kinds.includes(name) ? value : 0), 0);
  };
  const before = await sum();
  await gesture();
  const spent = (await sum()) - before;
  await session.detach();
  return 1000 * spent;
}

/** Measure a page for some seconds. Only canvases that a selector names count for `least`. */
export async function smoothness(
  browser: Browser,
  page: Page,
  seconds: number,
  canvases: string,
): Promise<Smoothness> {
  const inside = await page.context().newCDPSession(page);
  const outside = await browser.newBrowserCDPSession();
  await inside.send("Performance.enable");
  const costs = async () => {
    const { metrics } = await inside.send("Performance.getMetrics");
    const { processInfo } = await outside.send("SystemInfo.getProcessInfo");
    const sum = (type: RegExp) =>
      processInfo.filter((one) => type.test(one.type)).reduce((total, one) => total + one.cpuTime, 0);
    return {
      script: metrics.find(({ name }) => name === "ScriptDuration")?.value ?? NaN,
      renderer: sum(/renderer/i),
      gpu: sum(/gpu/i),
    };
  };
  const before = await costs();
  const { gaps, least, wall } = await page.evaluate(
    async ({ ms, canvases }) => {
      const counts = () =>
        [...document.querySelectorAll<HTMLCanvasElement>(canvases)].map(
          (one) => window.probe.drawn.get(one)?.times ?? 0,
        );
      const start = counts();
      const times: number[] = [];
      const from = performance.now();
      await new Promise<void>((done) => {
        const next = (now: number) => {
          times.push(now);
          if (now - from < ms) requestAnimationFrame(next);
          else done();
        };
        requestAnimationFrame(next);
      });
      const wall = (performance.now() - from) / 1000;
      const end = counts();
      const each = end.length === start.length ? end.map((n, i) => n - (start[i] ?? 0)) : [];
      return {
        gaps: times.slice(1).map((t, i) => t - (times[i] ?? 0)),
        least: each.length > 0 ? Math.min(...each) / wall : 0,
        wall,
      };
    },
    { ms: 1000 * seconds, canvases },
  );
  const after = await costs();
  await Promise.all([inside.detach(), outside.detach()]);
  const each = (name: keyof typeof before) => (1000 * (after[name] - before[name])) / gaps.length;
  return {
    rate: gaps.length / wall,
    p95: quantile(gaps, 0.95),
    least,
    script: each("script"),
    renderer: each("renderer"),
    gpu: each("gpu"),
  };
}
