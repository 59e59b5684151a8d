/** Large architectures: the boxes of a grid, couplings on wires, stimuli in boxes. */
import { readFileSync } from "node:fs";
import { join } from "node:path";

import type { Page } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";

import { obstacles } from "./axe";
import { box, button, panel, showEverything } from "./hands";
import { behind, misplacedNames, overlaps } from "./legibility";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

const FOLDER = join(import.meta.dirname, "../../tests/deodar_interop/importers/cosivina");
const SCENE = "presetSceneRepresentation.json";
const BOXES = 20;
const WIRES = 86;
const SIZES = [
  { width: 1440, height: 900 },
  { width: 1024, height: 700 },
];

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({ files: { [SCENE]: readFileSync(join(FOLDER, SCENE), "utf8") }, file: SCENE });
  observer = await studio.observe();
});

afterAll(() => studio.stop());

const canvas = () => panel(studio.page, "Architecture");
const wires = () => canvas().locator(".react-flow__edge");
const inspected = (name: string) =>
  panel(studio.page, "Inspector").getByRole("heading", { name, exact: true });

async function search(page: Page, text: string): Promise<void> {
  await page.keyboard.press("Control+f");
  const field = page.getByRole("combobox", { name: "Search for an element" });
  await field.fill(text);
  await field.press("Enter");
  await field.waitFor({ state: "detached" });
}

test.each(SIZES)(
  "at $width px no box overlaps, no name is small or cut, no wire crosses a box",
  async (size) => {
    const { page } = studio;
    await page.setViewportSize(size);
    await page.reload();
    await expect.poll(() => canvas().locator(".graph-box").count()).toBe(BOXES);
    await expect.poll(() => wires().count()).toBe(WIRES);
    await expect
      .poll(() => misplacedNames(page), { message: "names that are too small or outside" })
      .toEqual([]);
    expect(await overlaps(page), "boxes that overlap").toEqual([]);
    expect(await behind(page), "wires behind boxes").toEqual([]);
    expect(await obstacles(page)).toEqual([]);
    await shot(page, `contracted-${size.width}`);
  },
);

test("a contracted element is found by its name, selected and revealed", async () => {
  const { page } = studio;
  await search(page, "atn_sr -> ior_s");
  await inspected("atn_sr -> ior_s").waitFor();
  expect(await page.getByRole("button", { name: /^atn_sr -> ior_s/ }).getAttribute("aria-pressed")).toBe(
    "true",
  );
  await shot(page, "contracted-wire");
  await search(page, "i3 for vis_f1");
  await inspected("i3 for vis_f1").waitFor();
  await expect.poll(() => button(page, "i3 for vis_f1").getAttribute("aria-pressed")).toBe("true");
});

test("the wires of a selected box are in front, others are faint, and a chip selects", async () => {
  const { page } = studio;
  await search(page, "wm_s");
  await inspected("wm_s").waitFor();
  const far = canvas().locator(".graph-box[data-far]");
  await expect.poll(() => far.count()).toBeGreaterThan(0);
  expect(await far.count()).toBeLessThan(BOXES - 1);
  await expect.poll(() => canvas().locator(".graph-wire[data-touched]").count()).toBeGreaterThan(3);
  await shot(page, "contracted-selected");
  const chip = canvas().locator(".graph-chip", { hasText: /^1$/ }).first();
  const name = (await chip.getAttribute("title")) ?? "";
  await chip.focus();
  await page.keyboard.press("Enter");
  await inspected(name).waitFor();
});

test("a badge and a dot select by keyboard, and what is selected is removed and comes back", async () => {
  const { page } = studio;
  const before = observer.document?.elements.length ?? 0;
  await button(page, "boost wm_s").focus();
  await page.keyboard.press("Enter");
  await inspected("boost wm_s").waitFor();
  await page.keyboard.press("Delete");
  await observer.until(() => observer.document?.elements.length === before - 1);
  await button(page, "boost wm_s").waitFor({ state: "detached" });
  await page.keyboard.press("Control+z");
  await observer.until(() => observer.document?.elements.length === before);
  await button(page, "wm_s -> wm_s, on itself").click();
  await inspected("wm_s -> wm_s").waitFor();
});

test("every element is shown on request, and the document keeps the choice", async () => {
  const { page } = studio;
  await button(page, "Show every element").click();
  await box(page, "boost wm_s").waitFor();
  await observer.until(() => observer.document?.layout.every_element === true);
  await shot(page, "contracted-every");
  await page.reload();
  await box(page, "boost wm_s").waitFor();
  await button(page, "Couplings on wires, stimuli in boxes").click();
  await box(page, "boost wm_s").waitFor({ state: "detached" });
  await expect.poll(() => canvas().locator(".graph-box").count()).toBe(BOXES);
});

test("dragged boxes keep their places, Tidy returns to the grid, and undo reverses it", async () => {
  const { page } = studio;
  await showEverything(page);
  const dragged = ["cos", "wm_s"];
  const ids = dragged.map((name) => observer.element(name).id);
  const places = () => ids.map((id) => observer.document?.layout.boxes[id]);
  // where the canvas draws them, in its own units
  const drawn = () =>
    Promise.all(
      ids.map((id) =>
        canvas()
          .locator(`.react-flow__node[data-id="${id}"]`)
          .evaluate((node) => {
            const { e, f } = new DOMMatrix(getComputedStyle(node).transform);
            return { x: Math.round(e), y: Math.round(f) };
          }),
      ),
    );
  const rounded = () => places().map((at) => at && { x: Math.round(at.x), y: Math.round(at.y) });
  const grid = await drawn();
  expect(places(), "places that a person chose").toEqual([undefined, undefined]);
  for (const [i, name] of dragged.entries()) {
    const at = await box(page, name).boundingBox();
    if (at === null) throw new Error("The box is not visible.");
    await page.mouse.move(at.x + 12, at.y + 8);
    await page.mouse.down();
    await page.mouse.move(at.x + 24, at.y + 20, { steps: 6 });
    await page.mouse.up();
    await observer.until(() => places()[i] !== undefined);
  }
  const chosen = rounded();
  for (const [i, at] of chosen.entries()) expect(at, dragged[i]).not.toEqual(grid[i]);
  await expect.poll(drawn).toEqual(chosen);
  await shot(page, "contracted-dragged");
  await page.reload();
  await expect.poll(() => canvas().locator(".graph-box").count()).toBe(BOXES);
  await expect.poll(drawn).toEqual(chosen);
  await button(page, "Tidy to grid").click();
  await observer.until(() => places().every((at) => at === undefined));
  await expect.poll(drawn).toEqual(grid);
  expect(await canvas().locator(".graph-box").count()).toBe(BOXES);
  await shot(page, "contracted-tidy");
  await page.keyboard.press("Control+z");
  await observer.until(() => places().every((at) => at !== undefined));
  await expect.poll(drawn).toEqual(chosen);
});
