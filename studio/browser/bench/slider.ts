/** From a key on a slider to the drawing of a field's response. */
import type { Page } from "playwright-core";

import { ident } from "./documents";
import "./probe";

const FIELD = "activation";
/** A step of the mean is not noise if it exceeds the largest earlier step by this factor. */
const CLEAR = 3;
const FORMER = 40;

/**
 * Move the resting level of an element from one end of its range to the other by keys. Returns for each key
 * the ms from the key event to the end of the picture in which the plot drew the first frame whose mean left
 * the range that noise alone had caused before.
 */
export async function slid(page: Page, element: string, times: number): Promise<number[]> {
  await page
    .getByRole("group", { name: `Drawing of ${element}` })
    .first()
    .waitFor();
  await page.locator(`.react-flow__node[data-id="${ident(element)}"]`).click();
  const slider = page.getByRole("slider", { name: /^resting.level$/i }).first();
  await slider.focus();
  await page.evaluate(watch, { element: ident(element), port: FIELD, clear: CLEAR, former: FORMER });
  const all: number[] = [];
  for (let i = 0; i < times; i++) {
    await page.waitForFunction(() => window.answers.calm(), undefined, { polling: 50 });
    await page.waitForTimeout(17 * Math.random());
    await page.keyboard.press(i % 2 === 0 ? "Home" : "End");
    await page.waitForFunction((n) => window.answers.all.length > n, i, { polling: 50 });
    all.push(await page.evaluate(() => window.answers.all.at(-1) ?? NaN));
  }
  return all;
}

declare global {
  interface Window {
    answers: { all: number[]; calm: () => boolean };
  }
}

function watch({
  element,
  port,
  clear,
  former,
}: {
  element: string;
  port: string;
  clear: number;
  former: number;
}): void {
  const { probe } = window;
  const canvas = document.querySelector(".plot-host > .plot-canvas") as HTMLCanvasElement;
  const streams = new Set(
    [...probe.watched]
      .filter(([, wish]) => wish.element === element && wish.port === port && (wish.most ?? 0) > 100)
      .map(([number]) => number),
  );
  const means: number[] = [];
  const answers = { all: [] as number[], calm: () => pressed === null && means.length >= former };
  window.answers = answers;
  let pressed: number | null = null;
  let bound = 0;
  let last = NaN;

  addEventListener(
    "keydown",
    (event) => {
      pressed = event.timeStamp;
      // The largest difference between two frames that is still noise.
      bound = clear * Math.max(...means.slice(1).map((mean, i) => Math.abs(mean - (means[i] ?? mean))));
    },
    true,
  );
  probe.heard = (data) => {
    if (!streams.has(new DataView(data).getUint32(0, true))) {
      return;
    }
    const values = new Float32Array(data, 16);
    const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
    if (pressed !== null && bound > 0 && Math.abs(mean - last) > bound) {
      const began = pressed;
      const came = performance.now();
      bound = 0;
      // The browser's frame in which the plot is drawn after this message; it is complete when the next task
      // begins.
      const look = () => {
        if ((probe.drawn.get(canvas)?.at ?? 0) >= came) {
          const channel = new MessageChannel();
          channel.port1.onmessage = () => {
            answers.all.push(performance.now() - began);
            means.length = 0;
            pressed = null;
          };
          channel.port2.postMessage(0);
        } else {
          requestAnimationFrame(look);
        }
      };
      requestAnimationFrame(look);
    }
    // Noise is measured at rest: a frame that differs much from earlier ones restarts the measurement.
    if (pressed === null) {
      means.push(mean);
      if (means.length > former) {
        means.shift();
      }
      const all = means.length;
      if (all >= 10 && Math.abs(mean - (means[all - 10] ?? mean)) > 0.5) {
        means.length = 0;
      }
    }
    last = mean;
  };
}
