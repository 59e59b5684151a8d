/** The tool of activity: the order of its lines, names of fields above the threshold, what it asks for. */
import { readFileSync } from "node:fs";
import { join } from "node:path";

import type { Locator, Page } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";

import { obstacles } from "./axe";
import { box, colours, openTool, panel, reopen, showView } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

const SCENE = "presetSceneRepresentation.json";
const FOLDER = join(import.meta.dirname, "../../tests/deodar_interop/importers/cosivina");

let studio: Studio;
let observer: Observer;
/** The fields whose time courses the page asks for now. */
const asked = new Map<number, string>();

beforeAll(async () => {
  studio = await startStudio({
    copies: ["examples/behaviours.json"],
    files: { [SCENE]: readFileSync(join(FOLDER, SCENE), "utf8") },
  });
  observer = await studio.observe();
  studio.page.on("websocket", (socket) => {
    asked.clear();
    socket.on("framesent", ({ payload }) => {
      const { type, stream, element, reduce } = JSON.parse(String(payload));
      if (type === "trace" && reduce === "max") asked.set(stream, element);
      else if (type === "unwatch") asked.delete(stream);
    });
  });
  await studio.page.reload();
});

afterAll(() => studio.stop());

const lines = (page: Page): Locator => panel(page, "Activity").getByRole("option");
const line = (page: Page, name: string): Locator =>
  lines(page).filter({ has: page.getByText(name, { exact: true }) });

/** The names that are bold and ember, the ones that are one of both alone with a question mark. */
const emberNames = (page: Page): Promise<string[]> =>
  panel(page, "Activity").evaluate((tool) => {
    const probe = Object.assign(document.createElement("i"), { style: "color: var(--ember)" });
    tool.append(probe);
    const ember = getComputedStyle(probe).color;
    probe.remove();
    return [...tool.querySelectorAll(".activity-name")].flatMap((name) => {
      const { color, fontWeight } = getComputedStyle(name);
      const signs = [color === ember, Number(fontWeight) >= 600];
      const text = name.textContent ?? "";
      return signs.every(Boolean) ? [text] : signs.some(Boolean) ? [`${text}?`] : [];
    });
  });

const isSelected = (of: Locator): Promise<boolean> =>
  of.evaluate((element) => element.closest(".react-flow__node")?.classList.contains("selected") === true);

/** The distance of the middle of a box from the middle of the canvas, in px. */
async function offCentre(of: Locator): Promise<number> {
  const [inner, outer] = await Promise.all([
    of.boundingBox(),
    studio.page.locator(".react-flow__pane").boundingBox(),
  ]);
  if (inner === null || outer === null) return Infinity;
  const [x, y] = [inner.x + inner.width / 2, inner.y + inner.height / 2];
  return Math.hypot(x - outer.x - outer.width / 2, y - outer.y - outer.height / 2);
}

test("names are ember and bold as long as their field is above the threshold", async () => {
  const { page } = studio;
  await reopen(page, observer, "behaviours.json");
  await openTool(page, "Activity");
  await lines(page).first().waitFor();
  await observer.ask({ type: "step", n: 1 });
  await expect.poll(() => line(page, "intention").first().innerText()).toMatch(/−\d/);
  expect(await emberNames(page)).toEqual([]);
  await observer.ask({ type: "step", n: 400 });
  await expect.poll(() => emberNames(page)).not.toEqual([]);
  expect((await emberNames(page)).join(" ")).not.toContain("?");
  const [first = ""] = await emberNames(page);
  expect(await colours(line(page, first).first().locator("canvas"))).toBeGreaterThan(2);
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "activity-light");
  await observer.ask({ type: "reset" });
  await expect.poll(() => emberNames(page)).toEqual([]);
});

test("in the order of the grid; what is out of view asks for nothing", async () => {
  const { page } = studio;
  await page.setViewportSize({ width: 1440, height: 560 });
  await observer.ask({ type: "open_file", path: SCENE, discard: true });
  await observer.runs();
  await openTool(page, "Activity");
  await expect.poll(() => lines(page).count()).toBe(20);
  await expect.poll(() => lines(page).last().locator("canvas").count()).toBe(0);
  const shown = () => lines(page).locator("canvas").count();
  expect(await shown()).toBeLessThan(20);
  await expect.poll(() => new Set(asked.values()).size).toBe(await shown());
  const last = observer.element(await lines(page).last().innerText());
  expect([...asked.values()]).not.toContain(last.id);
  await lines(page).last().scrollIntoViewIfNeeded();
  await expect.poll(() => [...asked.values()]).toContain(last.id);
  await expect.poll(() => new Set(asked.values()).size).toBe(await shown());
  await page.setViewportSize({ width: 1440, height: 900 });
  await expect.poll(shown).toBe(20);
  await observer.ask({ type: "step", n: 300 });
  await expect.poll(async () => (await emberNames(page)).length).toBeGreaterThan(5);
  await shot(page, "activity-grid");
  await openTool(page, "Inspector");
  await expect.poll(() => asked.size, { message: "a hidden tool asks for nothing" }).toBe(0);
});

test("a click and Enter select an element and centre its box, also from another view", async () => {
  const { page } = studio;
  await openTool(page, "Activity");
  await line(page, "wm_c2").click();
  await expect.poll(() => isSelected(box(page, "wm_c2"))).toBe(true);
  await expect.poll(() => offCentre(box(page, "wm_c2"))).toBeLessThan(4);
  expect(await line(page, "wm_c2").getAttribute("aria-selected")).toBe("true");
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowDown");
  const second = (await lines(page).nth(1).locator(".activity-name").innerText()).trim();
  expect(
    await lines(page)
      .nth(1)
      .evaluate((one) => one === document.activeElement),
  ).toBe(true);
  await page.keyboard.press("Enter");
  await expect.poll(() => isSelected(box(page, second))).toBe(true);
  await expect.poll(() => offCentre(box(page, second))).toBeLessThan(4);
  expect(
    await lines(page)
      .nth(1)
      .evaluate((one) => one === document.activeElement),
    "the focus stays",
  ).toBe(true);
  await showView(page, "Run");
  await openTool(page, "Activity");
  await line(page, "wm_c2").click();
  await expect.poll(() => isSelected(box(page, "wm_c2"))).toBe(true);
  await expect.poll(() => offCentre(box(page, "wm_c2"))).toBeLessThan(4);
});

test("in dark mode, beside plots, nothing is hard to read", async () => {
  const { page } = studio;
  await page.emulateMedia({ colorScheme: "dark", reducedMotion: "reduce" });
  await showView(page, "Run");
  await openTool(page, "Activity");
  await expect.poll(() => lines(page).locator("canvas").count()).toBe(20);
  await expect.poll(async () => (await emberNames(page)).length).toBeGreaterThan(5);
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "activity-dark");
});
