import { expect, onTestFinished, test } from "vitest";

import { many } from "./bench/documents";
import { button } from "./hands";
import { startStudio } from "./studio";

const COUNT = 200;
/** How many times slower than this machine the page runs. */
const SLOWER = 12;

test("on a slow machine every box of 200 is drawn, and none much less often than the others", async () => {
  const { page, context, stop, observe } = await startStudio({
    files: { "many.json": JSON.stringify(many(COUNT)) },
  });
  onTestFinished(stop);
  const observer = await observe();
  await page.evaluate(() => {
    const drawn = new Map<HTMLCanvasElement, number>();
    const { clearRect } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.clearRect = function (...area) {
      const counted = this.canvas as HTMLCanvasElement;
      if (counted.hidden) drawn.set(counted, (drawn.get(counted) ?? 0) + 1);
      clearRect.apply(this, area);
    };
    Object.assign(window, { drawn });
  });
  const counts = () =>
    page.evaluate(() => [...(window as unknown as { drawn: Map<unknown, number> }).drawn.values()]);
  await observer.ask({ type: "open_file", path: "many.json" });
  await observer.runs();
  await expect.poll(() => page.locator(".graph-live").count()).toBe(COUNT);
  const session = await context.newCDPSession(page);
  await session.send("Emulation.setCPUThrottlingRate", { rate: SLOWER });
  await button(page, "Play").click();
  await observer.until(() => observer.running);
  await page.evaluate(() => (window as unknown as { drawn: Map<unknown, number> }).drawn.clear());
  await page.waitForTimeout(15_000);
  const found = await counts();
  await session.send("Emulation.setCPUThrottlingRate", { rate: 1 });
  expect(found).toHaveLength(COUNT);
  expect(Math.min(...found)).toBeGreaterThanOrEqual(Math.max(...found) / 2 - 1);
});
