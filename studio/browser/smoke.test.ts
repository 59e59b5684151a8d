/** Every view of the studio opens and draws something, in one studio. */
import { afterAll, beforeAll, expect, test } from "vitest";

import { TITLES } from "../src/frame/titles";
import { TOOLS } from "../src/frame/tools";
import { PLOTS } from "../src/plots/kinds/plots";
import { SHOWN, writeArranged, writeEveryPlot } from "./everyPlot";
import { choose, openExample, panel, reopen, showView } from "./hands";
import { examplePackage } from "./installed";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;

beforeAll(async () => {
  studio = await startStudio(examplePackage());
  await writeEveryPlot(studio.folder);
});

afterAll(() => studio.stop());

test("the gallery opens where the language of the browser is none, as under the locale C", async () => {
  await studio.context.addInitScript(() =>
    Object.defineProperty(navigator, "language", { value: "C", configurable: true }),
  );
  const page = await studio.another();
  await page.getByRole("heading", { name: "Examples" }).waitFor();
  await page.close();
});

test("an example runs, and every panel opens", async () => {
  const { page } = studio;
  await openExample(page, "Selection");
  await page.getByRole("region", { name: "Curves of u" }).locator("canvas").first().waitFor();
  const tools = [...TOOLS.values()].map(({ title }) => title);
  for (const title of [...tools, ...Object.values(TITLES)]) {
    await choose(page, "Open panels and plots", title);
    await expect.poll(() => panel(page, title).innerText(), { message: title }).not.toBe("");
  }
  await shot(page, "smoke");
});

test("every kind of plot draws", async () => {
  const { page } = studio;
  const observer = await studio.observe();
  const shown = Object.entries(SHOWN).map(([kind, [element]]) => [element, kind] as const);
  writeArranged(studio.folder, "shown.json", [shown.slice(0, 4), shown.slice(4, 8), shown.slice(8)]);
  await reopen(page, observer, "shown.json");
  await showView(page, "Run");
  await observer.ask({ type: "step", n: 2 });
  expect(await page.evaluate(() => document.createElement("canvas").getContext("webgl2") !== null)).toBe(
    true,
  );
  for (const [element, kind] of shown) {
    const name = `${PLOTS.get(kind)?.title ?? "Polar plot"} of ${element}`;
    const plot = page.getByRole("region", { name, exact: true });
    await plot.scrollIntoViewIfNeeded();
    await plot.locator("canvas, svg").first().waitFor();
    await expect.poll(() => plot.getByText("Press play").count(), { message: name }).toBe(0);
  }
  await shot(page, "smoke-plots");
});
