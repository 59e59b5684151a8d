import { readFileSync } from "node:fs";
import { join } from "node:path";

import { afterAll, beforeAll, expect, onTestFinished, test } from "vitest";

import { beside, button } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

const SELECTION = join(import.meta.dirname, "../../examples/selection.json");
const SLOW = join(import.meta.dirname, "python", "slow.py");
const WIDTHS = [1280, 900, 640, 390];
let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({ copies: ["examples/saliency.json"], file: "saliency.json" });
  observer = await studio.observe();
  await observer.runs();
});

afterAll(() => studio.stop());

/** Controls of the head and the foot of the page that overlap or leave it, by their names. */
const overlapping = () =>
  studio.page.evaluate(() => {
    const inHead = "header :is(button, [role=group], [role=radiogroup], h1)";
    const inFoot = "footer :is(button, [role=timer], select)";
    const controls = [...document.querySelectorAll(`${inHead}, ${inFoot}`)]
      .map((one) => ({
        name: one.getAttribute("aria-label") ?? one.textContent,
        at: one.getBoundingClientRect(),
      }))
      .filter(({ at }) => at.width > 0);
    const out = controls.filter(({ at }) => at.left < -0.5 || at.right > innerWidth + 0.5);
    const over = controls.flatMap((one, i) =>
      controls
        .slice(i + 1)
        .filter(
          ({ at }) =>
            Math.min(at.right, one.at.right) - Math.max(at.left, one.at.left) > 1 &&
            Math.min(at.bottom, one.at.bottom) - Math.max(at.top, one.at.top) > 1,
        )
        .map((other) => `${one.name} and ${other.name}`),
    );
    return [...out.map(({ name }) => `${name} is outside`), ...over];
  });

test("no control of the head or the foot overlaps another one at any width, paused or running", async () => {
  const { page } = studio;
  await observer.ask({ type: "speed", factor: null });
  for (const running of [false, true]) {
    if (running) {
      await button(page, "Play").click();
      await observer.until(() => observer.time > 12_000);
    }
    for (const width of WIDTHS) {
      await page.setViewportSize({ width, height: 800 });
      await expect.poll(overlapping, { message: `${width} ${running}` }).toEqual([]);
      await shot(page, `header-${width}-${running ? "running" : "paused"}`);
    }
  }
  await button(page, "Pause").click();
  await page.emulateMedia({ colorScheme: "dark" });
  for (const width of WIDTHS) {
    await page.setViewportSize({ width, height: 800 });
    await shot(page, `header-${width}-dark`);
  }
});

test("while it compiles the page shows the step, the phase and the time", async () => {
  const selection = JSON.parse(readFileSync(SELECTION, "utf8")) as object;
  const { page, stop, observe } = await startStudio({
    files: { "slow.py": readFileSync(SLOW, "utf8"), "coarse.json": JSON.stringify({ ...selection, dt: 4 }) },
    imports: ["slow"],
  });
  onTestFinished(stop);
  const second = await observe();
  await second.ask({ type: "open_file", path: "coarse.json" });
  const status = page.getByRole("toolbar", { name: "Run" }).getByRole("status");
  await status.getByText("planning").waitFor();
  await status.getByText(/^[1-9] s$/).waitFor();
  await shot(page, "compiling");
  await beside(page, "Run settings", async (settings) => {
    const dt = settings.getByRole("textbox", { name: "Time step dt" });
    expect(await dt.inputValue()).toBe("4");
  });
  await page.setViewportSize({ width: 390, height: 800 });
  expect(await overlapping()).toEqual([]);
  await page.locator("footer").getByText("planning").locator("visible=true").first().waitFor();
  await shot(page, "compiling-390");
  await second.runs();
  await status.getByText("planning").waitFor({ state: "detached" });
  // the next program of this size is expected to take as long
  await second.ask({ type: "close", discard: true });
  await second.ask({ type: "open_file", path: "coarse.json" });
  await second.until(() => (second.clock?.compiling?.expected ?? 0) > 3);
});
