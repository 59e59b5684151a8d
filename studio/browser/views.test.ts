/** Every view at two sizes and in two colour schemes: what everybody can read and press, in one typeface. */
import type { Page } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";

import { obstacles } from "./axe";
import { showView } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

const SIZES = [
  [1440, 900],
  [1024, 700],
] as const;
const VIEWS = ["Build", "Run", "Experiment", "Robot"] as const;

let studio: Studio;
let observer: Observer;
const elsewhere: string[] = [];

beforeAll(async () => {
  studio = await startStudio();
  observer = await studio.observe();
  const { origin } = new URL(studio.url);
  studio.page.on("request", (request) => {
    const url = new URL(request.url());
    if (url.origin !== origin && ["http:", "https:"].includes(url.protocol)) elsewhere.push(request.url());
  });
});

afterAll(() => studio.stop());

/** Text below 11 px of the screen, on the canvas below 10, or in another typeface; equations aside. */
const unreadable = (page: Page): Promise<string[]> =>
  page.evaluate(() => {
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    const found: string[] = [];
    for (let node = walker.nextNode(); node !== null; node = walker.nextNode()) {
      const element = node.parentElement;
      const text = node.textContent?.trim() ?? "";
      if (element === null || text === "" || element.closest(".katex, style, script") !== null) continue;
      const { width, height } = element.getBoundingClientRect();
      const shown = element.checkVisibility({ opacityProperty: true, visibilityProperty: true });
      if (!shown || width < 2 || height < 2) continue;
      const style = getComputedStyle(element);
      const viewport = element.closest(".react-flow__viewport");
      const zoom = viewport === null ? 1 : new DOMMatrix(getComputedStyle(viewport).transform).a;
      const size = zoom * Number.parseFloat(style.fontSize);
      if (size < (viewport === null ? 11 : 10) - 0.05) found.push(`${text}: ${size.toFixed(1)} px`);
      const [family = ""] = style.fontFamily.split(",");
      const code = element.closest("code, pre, kbd, textarea, .mono") !== null;
      if (!code && !family.includes("Inter")) found.push(`${text}: ${family}`);
    }
    return found;
  });

const overflows = (page: Page): Promise<boolean> =>
  page.evaluate(() => document.documentElement.scrollWidth > window.innerWidth);

async function everything(page: Page): Promise<string[]> {
  return [
    ...(await obstacles(page)),
    ...(await unreadable(page)),
    ...((await overflows(page)) ? ["scrolls sideways"] : []),
  ];
}

/** Both documents have all that a view can show: groups, couplings, parameters and plots; and a world. */
const DOCUMENTS = ["plan", "pointing"];

test.each(
  ["light", "dark"].flatMap((scheme) => SIZES.map(([width, height]) => [scheme, width, height] as const)),
)("every view in %s colours at %i x %i", async (scheme, width, height) => {
  const { page } = studio;
  await page.emulateMedia({ colorScheme: scheme as "light" | "dark", reducedMotion: "reduce" });
  await page.setViewportSize({ width, height });
  await observer.ask({ type: "close", discard: true });
  await page.getByRole("heading", { name: "Examples" }).waitFor();
  await expect.poll(() => everything(page), { message: "gallery" }).toEqual([]);
  for (const name of DOCUMENTS) {
    await observer.ask({ type: "open_example", name, discard: true });
    await observer.runs();
    for (const view of VIEWS) {
      await showView(page, view);
      await expect.poll(() => everything(page), { message: `${view} of ${name}` }).toEqual([]);
      await shot(page, `view-${name}-${view}-${width}-${scheme}`);
    }
  }
  expect(elsewhere, "requests that leave the machine").toEqual([]);
});
