/**
 * Write the pictures of the manual's chapter on building by mouse, light and dark, 1280 x 800, into the
 * folder that DEODAR_SHOTS names.
 */
import type { Page } from "playwright-core";
import { onTestFinished, test } from "vitest";

import { box, button, drag, openEmpty, option, place, pull, showEverything, slider } from "../hands";
import type { Observer } from "../observer";
import { shot, startStudio } from "../studio";

const COLOURS = ["light", "dark"] as const;
// Until what was opened or moved is drawn.
const DRAWN_MS = 600;

for (const colours of COLOURS) {
  const name = (what: string) => (colours === "dark" ? `studio-${what}-dark` : `studio-${what}`);

  async function begin(): Promise<{ page: Page; observer: Observer }> {
    const studio = await startStudio({ colours });
    onTestFinished(studio.stop);
    const observer = await studio.observe();
    await openEmpty(studio.page, observer);
    return { page: studio.page, observer };
  }

  test(`a first field, ${colours}`, async () => {
    const { page, observer } = await begin();
    const [first, second, field] = [
      await place(page, 0.2, 0.2),
      await place(page, 0.2, 0.6),
      await place(page, 0.55, 0.4),
    ];
    await page.mouse.dblclick(first.x, first.y);
    await option(page, "Gaussian stimulus").click();
    await box(page, "gaussian_stimulus").waitFor();
    await pull(page, "gaussian_stimulus", field);
    await page.mouse.up();
    await option(page, "Field, 1-D").waitFor();
    await page.waitForTimeout(DRAWN_MS);
    await shot(page, name("palette"));
    await option(page, "Field, 1-D").click();
    await box(page, "field").waitFor();
    await page.mouse.dblclick(second.x, second.y);
    await option(page, "Gaussian stimulus").click();
    await box(page, "gaussian_stimulus2").waitFor();
    await drag(page, slider(page, "center"), 0.73);
    const target = await box(page, "field").boundingBox();
    await pull(page, "gaussian_stimulus2", { x: (target?.x ?? 0) + 40, y: (target?.y ?? 0) + 40 });
    await page.mouse.up();
    await button(page, "Play").click();
    await observer.until(() => observer.max("field", "activation") > 0);
    await observer.until(() => observer.time > 500);
    await page.getByRole("button", { name: /^pause/i }).click();
    await box(page, "field").click();
    await page.mouse.move(420, 4);
    await page.waitForTimeout(DRAWN_MS);
    await shot(page, name("built"));
  });

  test(`a connection is drawn, ${colours}`, async () => {
    const { page, observer } = await begin();
    const add = (kind: string, called: string, at: [number, number]) =>
      observer.ask({ type: "add_element", kind, name: called, at, values: {} });
    await add("Field", "u", [340, 0]);
    await add("GaussianStimulus", "left", [0, 40]);
    await add("GaussianStimulus", "right", [0, 240]);
    await add("RateNode", "node", [680, 40]);
    await add("MemoryTrace", "trace", [680, 240]);
    await observer.until(() => observer.document?.elements.length === 5);
    await box(page, "trace").waitFor();
    await showEverything(page);
    await page.waitForTimeout(DRAWN_MS);
    const target = await box(page, "node").boundingBox();
    await pull(page, "left", { x: (target?.x ?? 0) + 50, y: (target?.y ?? 0) + 40 });
    await page.waitForTimeout(DRAWN_MS);
    await shot(page, name("wire"));
    await page.mouse.up();
  });
}
