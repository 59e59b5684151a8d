import type { Page } from "playwright-core";
import { expect, onTestFinished, test } from "vitest";

import { crowding } from "./bench/crowding";
import { many } from "./bench/documents";
import { button } from "./hands";
import { startStudio } from "./studio";

const COUNT = 200;
/** How many times slower than this machine the page runs. */
const SLOWER = 12;
const LONGEST_MS = 1000;
const WINDOW_MS = 5000;
/** A box that starves does so in every window; a machine with other work misses the time in some. */
const WINDOWS = 4;
/** Most times longer that a window lasts where other processes slow the machine down. */
const MOST_CROWDED = 5;

type Watched = {
  begun: number;
  gaps: Map<HTMLCanvasElement, { last: number; longest: number }>;
  picture: number;
};

/** From now on note when each box is shown with a new drawing, and the time between two pictures. */
async function watch(page: Page): Promise<void> {
  await page.evaluate(() => {
    const watched: Watched = { begun: 0, gaps: new Map(), picture: 0 };
    Object.assign(window, { watched });
    const changed = new Set<HTMLCanvasElement>();
    const { clearRect, drawImage } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.clearRect = function (...area) {
      if (this.canvas.hidden) changed.add(this.canvas);
      clearRect.apply(this, area);
    };
    // a box is shown when its picture is copied to the layer
    const copied = drawImage as (...given: unknown[]) => void;
    CanvasRenderingContext2D.prototype.drawImage = function (...given: unknown[]) {
      const [shown] = given;
      if (shown instanceof HTMLCanvasElement && changed.delete(shown)) {
        const now = performance.now();
        const { last, longest } = watched.gaps.get(shown) ?? { last: watched.begun, longest: 0 };
        watched.gaps.set(shown, { last: now, longest: Math.max(longest, now - last) });
      }
      copied.apply(this, given);
    };
    let before = performance.now();
    const look = () => {
      const now = performance.now();
      watched.picture = Math.max(watched.picture, now - before);
      before = now;
      requestAnimationFrame(look);
    };
    look();
  });
}

/** The architecture has 1280 px of it, in which each box has a live picture. */
const SIZE = { width: 1280 + 524, height: 800 };

/** A place on the canvas without a box or a connection. */
const ground = (page: Page) =>
  page.evaluate(() => {
    for (let y = 200; y < 600; y += 2)
      if (document.elementFromPoint(640, y)?.classList.contains("react-flow__pane")) return { x: 640, y };
    throw new Error("The canvas has no free place.");
  });

const begin = (page: Page) =>
  page.evaluate(() => {
    const { watched } = window as unknown as { watched: Watched };
    watched.begun = performance.now();
    watched.gaps.clear();
    watched.picture = 0;
  });

/**
 * The number of boxes, the longest time that one of them was shown without a new drawing, and its limit, on a
 * machine that is this many times slower because of other processes.
 */
const found = (page: Page, slower: number) =>
  page.evaluate((longest) => {
    const { gaps, picture } = (window as unknown as { watched: Watched }).watched;
    const now = performance.now();
    const all = [...gaps].filter(([canvas]) => canvas.isConnected).map(([, gap]) => gap);
    return {
      boxes: all.length,
      gap: Math.max(...all.map((one) => Math.max(one.longest, now - one.last))),
      // tolerated where the machine is loaded: the longest time between two pictures of the browser, once
      // until new values arrive, which are asked for with a picture, and once until they are drawn
      limit: longest + 2 * picture,
    };
  }, LONGEST_MS * slower);

/** What `found` of the first window in which each box was drawn in time, else of the last one. */
async function drawn(page: Page, during: (ms: number) => Promise<void>) {
  for (let left = WINDOWS; ; left--) {
    const slower = Math.min(MOST_CROWDED, crowding());
    await begin(page);
    await during(WINDOW_MS * slower);
    const seen = await found(page, slower);
    if (left === 1 || (seen.boxes === COUNT && seen.gap <= seen.limit)) return seen;
    console.log(`a window is repeated: ${JSON.stringify(seen)}`);
  }
}

test("each of 200 boxes is redrawn once a second, also while the canvas is moved", async () => {
  const { page, context, stop, observe } = await startStudio({
    files: { "many.json": JSON.stringify(many(COUNT)) },
  });
  onTestFinished(stop);
  await page.setViewportSize(SIZE);
  const observer = await observe();
  await watch(page);
  await observer.ask({ type: "open_file", path: "many.json" });
  await observer.runs();
  await expect.poll(() => page.locator(".graph-live").count()).toBe(COUNT);
  await button(page, "Play").click();
  await observer.until(() => observer.running);

  const { x, y } = await ground(page);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 4, y + 4);
  const moved = await drawn(page, async (ms) => {
    const end = Date.now() + ms;
    for (let i = 0; Date.now() < end; i++) {
      await page.mouse.move(x + 12 * Math.sin(i / 12), y + 12 * Math.cos(i / 15));
    }
  });
  expect(await page.locator(".graph[data-moving]").count(), "the canvas is moved").toBe(1);
  await page.mouse.up();
  console.log(`moved: ${JSON.stringify(moved)}`);
  expect(moved.boxes).toBe(COUNT);
  expect(moved.gap).toBeLessThanOrEqual(moved.limit);

  const session = await context.newCDPSession(page);
  await session.send("Emulation.setCPUThrottlingRate", { rate: SLOWER });
  await page.waitForTimeout(2000);
  const slow = await drawn(page, (ms) => page.waitForTimeout(ms));
  await session.send("Emulation.setCPUThrottlingRate", { rate: 1 });
  console.log(`slow: ${JSON.stringify(slow)}`);
  expect(slow.boxes).toBe(COUNT);
  expect(slow.gap).toBeLessThanOrEqual(slow.limit);
}, 400_000);
