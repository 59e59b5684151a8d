import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { button, choose, colours, downloaded, drawn, reopen } from "./hands";
import { examplePackage, infoOf } from "./installed";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

/** A plot that raises an exception instead of drawing. */
const FAILING = 'export function draw() { throw new RangeError("no radius"); }';
const ABOUT = 'TITLE = "Failing plot"\nFILE = "failing.js"\nAXES = 1\n';

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  // The package of the repository, and one whose plot fails.
  const { copies, folders } = examplePackage();
  studio = await startStudio({
    copies: ["examples/motor_attractor.json", ...copies],
    files: { "failing.py": ABOUT, "failing.js": FAILING },
    folders: {
      ...folders,
      "failing-0.1.0.dist-info": infoOf("failing", "[deodar.plots]\nfailing = failing\n"),
    },
    file: "motor_attractor.json",
    expected: [/RangeError: no radius/],
  });
  observer = await studio.observe();
});

beforeEach(() => reopen(studio.page, observer, "motor_attractor.json"));

afterAll(() => studio.stop());

async function step(n: number): Promise<void> {
  await observer.ask({ type: "step", n });
  await observer.until(() => observer.clock?.tick === n);
}

test("a plot of a package is drawn again with new values and sizes, and is exported", async () => {
  const { page } = studio;
  await choose(page, "Menu of this plot", "Polar plot");
  const plot = page.getByRole("region", { name: "Polar plot of target", exact: true });
  const drawing = plot.getByRole("img", { name: "Polar plot of activation of target", exact: true });
  await step(100);
  await plot.getByText("Press play to see values").waitFor({ state: "detached" });
  await expect.poll(() => colours(drawing)).toBeGreaterThan(5);
  const before = await drawn(drawing);
  await observer.ask({ type: "step", n: 300 });
  await observer.until(() => observer.clock?.tick === 400);
  await expect.poll(() => drawn(drawing)).not.toBe(before);
  await shot(page, "plot-packaged");

  const picture = await downloaded(page, () => choose(page, "Menu of this plot", "Export PNG"));
  expect(picture.suggestedFilename()).toBe("target_activation.png");

  const width = await drawing.evaluate((canvas) => (canvas as HTMLCanvasElement).width);
  await page.setViewportSize({ width: 1000, height: 700 });
  await expect
    .poll(() => drawing.evaluate((canvas) => (canvas as HTMLCanvasElement).width))
    .toBeLessThan(width);
  await expect.poll(() => colours(drawing)).toBeGreaterThan(5);
  await page.setViewportSize({ width: 1280, height: 800 });
});

test("a plot that raises an exception shows it with its package, and the page continues", async () => {
  const { page } = studio;
  await choose(page, "Menu of this plot", "Failing plot");
  const plot = page.getByRole("region", { name: "Failing plot of target", exact: true });
  await step(10);
  await plot
    .getByText('The plot "Failing plot" of the package failing 0.1.0 failed: RangeError: no radius')
    .waitFor();
  await choose(page, "Menu of this plot", "Curves");
  const curves = page.getByRole("region", { name: "Curves of target", exact: true });
  await expect.poll(() => colours(curves.locator("canvas").first())).toBeGreaterThan(5);
  await button(page, "Play").click();
  await observer.until(() => (observer.clock?.tick ?? 0) > 10);
  await button(page, "Pause").click();
});
