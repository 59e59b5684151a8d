/** The names on the canvas of every example can be read, on a wide and on a narrow page. */
import { readdirSync } from "node:fs";
import { join } from "node:path";

import { afterAll, beforeAll, expect, test } from "vitest";

import { panel, showView } from "./hands";
import { misplacedNames, overlaps } from "./legibility";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

const FOLDER = join(import.meta.dirname, "..", "..", "examples");
const EXAMPLES = readdirSync(FOLDER)
  .filter((name) => name.endsWith(".json"))
  .map((name) => name.slice(0, -".json".length));
const WIDE = 1440;
/** Examples with more boxes than a canvas of this width has names for: they are dots at first. */
const DOTS = ["looking"];
const SIZES = [
  { width: WIDE, height: 900 },
  { width: 1024, height: 700 },
];

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio();
  observer = await studio.observe();
});

afterAll(() => studio.stop());

test.each(EXAMPLES)("the names of %s", async (name) => {
  const { page } = studio;
  const boxes = panel(page, "Architecture").locator(".graph-box, .graph-folded");
  for (const size of SIZES) {
    await observer.ask({ type: "close", discard: true });
    await page.setViewportSize(size);
    await page.getByRole("heading", { name: "Examples" }).waitFor();
    await observer.ask({ type: "open_example", name, discard: true });
    await showView(page, "Build");
    await boxes.first().waitFor();
    const known = observer.document?.elements.length ?? 0;
    expect(known).toBeGreaterThan(0);
    // the canvas comes to rest
    await expect.poll(() => misplacedNames(page), { message: `names at ${size.width} px` }).toEqual([]);
    expect(await overlaps(page), `boxes that overlap at ${size.width} px`).toEqual([]);
    const nameless = () =>
      boxes.evaluateAll((all) =>
        all
          .filter((one) => (one.querySelector(".graph-box-name")?.getBoundingClientRect().width ?? 0) === 0)
          .map((one) => one.textContent),
      );
    // where a canvas is too small for the names of an example, it shows dots
    if (size.width === WIDE && !DOTS.includes(name))
      await expect.poll(nameless, { message: `boxes without a name at ${size.width} px` }).toEqual([]);
    await shot(page, `example-${name}-${size.width}`);
  }
});
