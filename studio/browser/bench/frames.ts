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
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable", { timeDomain: "threadTicks" });
  const task = async () => {
    const { metrics } = await session.send("Performance.getMetrics");
    return metrics.find(({ name }) => name === "TaskDuration")?.value ?? NaN;
  };
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
  const before = await task();
  await gesture();
  const after = await task();
  const seconds = (performance.now() - from) / 1000;
  const frames = await count.evaluate((found) => {
    found.going = false;
    return found.frames;
  });
  await session.detach();
  return { rate: frames / seconds, cpu: (1000 * (after - before)) / frames };
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
