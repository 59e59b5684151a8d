/** The report on a file of cedar: its count, its lines, where a line leads, and what a saved file keeps. */
import { readFileSync } from "node:fs";
import { join } from "node:path";

import type { Locator } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";

import { obstacles } from "./axe";
import { box, button, file, openTool, panel, reopen, showView } from "./hands";
import { overlaps } from "./legibility";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

const SAMPLE = join(
  import.meta.dirname,
  "../../tests/deodar_interop/importers/cedar/data/elementaryBehavior.json",
);
const GROUP = "Elementary behavior";

/** The sample with an unknown step, an unknown parameter and a value without meaning. */
const LOSSY = [
  ['"name": "intention field"', '"name": "intention field", "colour": "red"'],
  ['"time scale": "100"', '"time scale": "slow"'],
  [/"cedar\.processing\.StaticGain":(\s*\{\s*"name": "new StaticGain 7")/, '"cedar.processing.Vision":$1'],
].reduce<string>(
  (text, [from, to]) => text.replace(from as string, to as string),
  readFileSync(SAMPLE, "utf8"),
);

/** The sample with a connection of the group that does not name a slot. */
const GROUPED = readFileSync(SAMPLE, "utf8").replace(
  '"source": "new Projection.output"',
  '"source": "new Projection"',
);

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({ files: { "behavior.json": LOSSY, "grouped.json": GROUPED } });
  observer = await studio.observe();
});

afterAll(() => studio.stop());

const report = (): Locator => panel(studio.page, "Import report");
const line = (words: string | RegExp): Locator => report().getByRole("option").filter({ hasText: words });
const mark = (): Locator => button(studio.page, "Import report: 5 not carried (2 approximated, 3 dropped)");
const show = (filter: string): Promise<void> =>
  report().getByRole("radiogroup", { name: "Lines to show" }).getByText(filter, { exact: true }).click();

/** Whether all of a box lies on the canvas. */
async function inView(of: Locator): Promise<boolean> {
  const [inner, outer] = await Promise.all([
    of.boundingBox(),
    panel(studio.page, "Architecture").boundingBox(),
  ]);
  return (
    inner !== null &&
    outer !== null &&
    inner.x >= outer.x &&
    inner.y >= outer.y &&
    inner.x + inner.width <= outer.x + outer.width &&
    inner.y + inner.height <= outer.y + outer.height
  );
}

const selected = (of: Locator): Promise<boolean> =>
  of.evaluate((element) => element.closest(".react-flow__node")?.classList.contains("selected") === true);

test("a file with losses opens, and the header counts what was not carried", async () => {
  const { page } = studio;
  await button(page, "Open a file").click();
  await page
    .getByRole("dialog", { name: "Open a file" })
    .getByRole("button", { name: "behavior.json" })
    .click();
  await mark().waitFor();
  expect(await mark().innerText()).toBe("5");
  await page
    .getByRole("region", { name: "Messages" })
    .getByText(/Imported from behavior\.json \(cedar\): 17 elements.* 2 approximated, 3 dropped/)
    .waitFor();
  await observer.runs();
  await shot(page, "report-notice");
  await button(page, "Dismiss").click();
});

test("a click on the count opens the report beside the architecture, with what was not carried", async () => {
  const { page } = studio;
  await mark().click();
  await report()
    .getByText("behavior.json (cedar): 205 of 210 items were carried, 2 approximated, 3 dropped")
    .waitFor();
  expect(await report().getByRole("option").count()).toBe(5);
  const groups = await report().getByRole("listbox").getByRole("group").all();
  const names = await Promise.all(groups.map((group) => group.getAttribute("aria-label")));
  expect(names.sort()).toEqual([
    `${GROUP}.CoS field`,
    `${GROUP}.intention field`,
    `${GROUP}.new StaticGain 7`,
    "The file as a whole",
  ]);
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "report-light");
});

test("lines are filtered by what became of them, and found by words", async () => {
  await show("Dropped 3");
  expect(await report().getByRole("option").count()).toBe(3);
  expect(await line("time scale").count()).toBe(0);
  await show("Approximated 2");
  await line(/time scale.*'slow'; 100.0 is used/).waitFor();
  expect(await report().getByRole("option").count()).toBe(2);
  await show("All 210");
  const search = report().getByRole("textbox", { name: "Find in the report" });
  await search.fill("intention field sigmoid");
  await line("sigmoid.threshold").waitFor();
  await search.fill("no such words");
  await report().getByText("No line has these words.").waitFor();
  await search.fill("");
  expect(await report().getByRole("option").count()).toBe(210);
  await shot(studio.page, "report-all");
  await show("Not carried 5");
});

test("keys lead from line to line, and Enter to the element, in a group that was folded", async () => {
  const { page } = studio;
  await button(page, `Fold ${GROUP}`).click();
  await box(page, `${GROUP}.intention field`).waitFor({ state: "detached" });
  await report().getByRole("textbox", { name: "Find in the report" }).focus();
  await page.keyboard.press("ArrowDown");
  const options = report().getByRole("option");
  expect(await options.first().evaluate((one) => one === document.activeElement)).toBe(true);
  const at = (await options.allInnerTexts()).findIndex((text) => text.includes("colour"));
  for (let i = 0; i < at; i++) await page.keyboard.press("ArrowDown");
  await page.keyboard.press("Enter");
  const field = box(page, `${GROUP}.intention field`);
  await field.waitFor();
  await expect.poll(() => selected(field)).toBe(true);
  await expect.poll(() => inView(field)).toBe(true);
  expect(await line("colour").evaluate((one) => one === document.activeElement), "the focus stays").toBe(
    true,
  );
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "report-led");
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("Enter");
  await expect.poll(() => selected(box(page, `${GROUP}.CoS field`))).toBe(true);
  await openTool(page, "Inspector");
  await panel(page, "Inspector").getByRole("heading", { name: "CoS field", exact: true }).waitFor();
  await openTool(page, "Import report");
  expect(await report().getByRole("option").count(), "the filter stays").toBe(5);
});

test("a renamed element keeps its lines, and those of a removed one say so", async () => {
  const { page } = studio;
  const { id } = observer.element(`${GROUP}.intention field`);
  await observer.ask({ type: "rename", element: id, name: "purpose" });
  await report().getByText(`${GROUP}.intention field in the file`).waitFor();
  await line("colour").click();
  await expect.poll(() => selected(box(page, `${GROUP}.purpose`))).toBe(true);
  await observer.ask({ type: "remove", elements: [observer.element(`${GROUP}.CoS field`).id] });
  await report().getByText("removed from the document").waitFor();
  await line("time scale").click();
  expect(await selected(box(page, `${GROUP}.purpose`)), "a plain line leads nowhere").toBe(true);
  await shot(page, "report-removed");
});

test("the saved document contains the report", async () => {
  const { page } = studio;
  await observer.ask({ type: "save", path: "own.json" });
  await reopen(page, observer, "own.json");
  await mark().waitFor();
  await file(page, "Import report");
  await line("colour").click();
  await expect.poll(() => selected(box(page, `${GROUP}.purpose`))).toBe(true);
  await report().getByText("removed from the document").waitFor();
});

test("the report is removed, and undo brings it back", async () => {
  const { page } = studio;
  await button(page, "Remove the report").click();
  await report().getByText("does not contain the report of it").waitFor();
  expect(await mark().count()).toBe(0);
  await page.keyboard.press("Control+z");
  await mark().waitFor();
  await line("colour").waitFor();
});

test("the report offers new places for the boxes, as one step of undo", async () => {
  const { page } = studio;
  const before = JSON.stringify(observer.document?.layout["boxes"]);
  const steps = observer.document?.undo ?? 0;
  await report().getByRole("button", { name: "Tidy to grid" }).click();
  await observer.until(() => JSON.stringify(observer.document?.layout["boxes"]) !== before);
  expect(observer.document?.undo).toBe(steps + 1);
  await expect.poll(() => overlaps(page)).toEqual([]);
  await shot(page, "report-tidy");
  await page.keyboard.press("Control+z");
  await observer.until(() => JSON.stringify(observer.document?.layout["boxes"]) === before);
});

test("a line opens the view of the architecture again where another one is shown", async () => {
  const { page } = studio;
  await showView(page, "Run");
  await openTool(page, "Import report");
  await line("gain factor").click();
  await panel(page, "Architecture").waitFor();
  const placeholder = box(page, `${GROUP}.new StaticGain 7`);
  await expect.poll(() => selected(placeholder)).toBe(true);
  await expect.poll(() => inView(placeholder)).toBe(true);
  expect(await line("gain factor").isVisible(), "the report stays open").toBe(true);
});

test("a line of a group leads to the group, and of a renamed group to its first element", async () => {
  const { page } = studio;
  await observer.ask({ type: "open_file", path: "grouped.json", discard: true });
  await observer.runs();
  await button(page, "Import report: 2 not carried (1 approximated, 1 dropped)").click();
  const broken = line("does not name two slots");
  await report()
    .getByRole("group", { name: `${GROUP} (group)` })
    .waitFor();
  await broken.click();
  const frame = page.locator(".graph-frame[data-selected]").filter({ hasText: GROUP });
  await frame.waitFor();
  await expect.poll(() => inView(frame)).toBe(true);
  await report().locator(".report-title[data-shown]").getByText(GROUP).waitFor();
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "report-group");
  await button(page, `Fold ${GROUP}`).click();
  await frame.waitFor({ state: "detached" });
  const folded = page.locator(".graph-folded[data-selected]").filter({ hasText: GROUP });
  await folded.waitFor();
  await page.locator(".react-flow__pane").click({ position: { x: 8, y: 8 } });
  await folded.waitFor({ state: "detached" });
  await broken.click();
  await folded.waitFor();
  await expect.poll(() => inView(folded)).toBe(true);
  await observer.ask({ type: "rename", group: [GROUP], name: "behavior" });
  await report().getByText(`group ${GROUP} in the file`).waitFor();
  await broken.click();
  const first = observer.document?.elements.find(({ group }) => group[0] === "behavior");
  await openTool(page, "Inspector");
  await panel(page, "Inspector")
    .getByRole("heading", { name: first?.name ?? "", exact: true })
    .waitFor();
});

test("a document without a report has no count, and its panel says so", async () => {
  const { page } = studio;
  await observer.ask({ type: "new", discard: true });
  await page.getByText("This document has no elements yet.").waitFor();
  expect(await mark().count()).toBe(0);
  await button(page, "Open panels and plots").click();
  await page.getByRole("menuitem", { name: "Import report" }).click();
  await report().getByText("This document was not made from a file of another tool").waitFor();
});

test("on a narrow page, dark, the report lies below the architecture", async () => {
  const { page } = studio;
  await page.emulateMedia({ colorScheme: "dark", reducedMotion: "reduce" });
  await page.setViewportSize({ width: 390, height: 800 });
  await observer.ask({ type: "open_file", path: "behavior.json", discard: true });
  await observer.runs();
  await mark().click();
  await line("colour").click();
  const field = box(page, `${GROUP}.intention field`);
  await expect.poll(() => selected(field)).toBe(true);
  await expect.poll(() => inView(field)).toBe(true);
  expect(await line("colour").isVisible(), "the report stays open").toBe(true);
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "report-narrow-dark");
  await page.setViewportSize({ width: 1280, height: 800 });
  await shot(page, "report-dark");
});
