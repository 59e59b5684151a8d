/** The studio opens, runs and tunes a file of another tool, and applies the values of a second file. */
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { afterAll, beforeAll, expect, test } from "vitest";

import { button, choose, colours, drawn, drop, file, openTool, panel, slider, type } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

const SCENE = "presetSceneRepresentation.json";
const ELEMENTS = 180; // the 168 of the file, and the kernels, equal inputs and sums that the importer makes
const CONTENT = readFileSync(
  join(import.meta.dirname, "../../tests/deodar_interop/importers/cosivina", SCENE),
  "utf8",
);

interface Part {
  label: string;
  class: string;
  param: Record<string, unknown>;
  input: unknown;
}

/** A preset: three elements of the file with other values, and one that the model does not have. */
function preset(): string {
  const { elements } = (JSON.parse(CONTENT) as { simulator: { elements: Part[] } }).simulator;
  const given = (label: string, param: Record<string, unknown>) => {
    const found = elements.find((one) => one.label === label) as Part;
    return { ...found, param: { ...found.param, ...param }, input: null };
  };
  const parts = [
    given("atn_sr", { h: -3 }),
    given("boost ior_s", { amplitude: 2 }),
    given("i1 for vis_f1", { amplitude: 0 }),
    { ...given("atn_sa", {}), label: "another field" },
  ];
  return JSON.stringify({ simulator: { elements: parts } });
}

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({ files: { [SCENE]: CONTENT, "preset.json": preset() } });
  observer = await studio.observe();
});

afterAll(() => studio.stop());

const notes = () => panel(studio.page, "Notes");
const took = () => studio.page.getByRole("dialog", { name: "What did not match" });

/** Find an element by its name and select it. */
async function find(name: string): Promise<void> {
  const { page } = studio;
  await button(page, "Search (Ctrl+F)").click();
  await page.getByRole("combobox", { name: "Search for an element" }).fill(name);
  await page
    .getByRole("option")
    .filter({ has: page.getByText(name, { exact: true }) })
    .click();
  await openTool(page, "Inspector");
  await panel(page, "Inspector").getByRole("heading", { name, exact: true }).waitFor();
}

async function choosePreset(name: string): Promise<void> {
  const { page } = studio;
  await file(page, /^Take over values/);
  await page
    .getByRole("dialog", { name: "Apply the values of a file" })
    .getByRole("button", { name })
    .click();
}

test("a file of another tool opens by its name, and the report lists what was imported", async () => {
  const { page } = studio;
  await button(page, "Open a file").click();
  await page.getByRole("dialog", { name: "Open a file" }).getByRole("button", { name: SCENE }).click();
  const said = page
    .getByRole("region", { name: "Messages" })
    .getByText(`Imported from ${SCENE} (cosivina): 168 elements`);
  await said.waitFor();
  await observer.until(() => observer.document?.elements.length === ELEMENTS);
  expect(observer.document?.file, "it is never written over").toBe("");

  await button(page, "Show the report").click();
  const report = panel(page, "Import report");
  await report.getByText("all 1461 items were carried").waitFor();
  const options = report.getByRole("option");
  expect(await options.count()).toBe(800);
  await button(page, "Show 661 more lines").click();
  await expect.poll(() => options.count()).toBe(1461);
  await report.getByRole("textbox", { name: "Find in the report" }).fill("cos -> cos ScaleInput");
  const group = report.getByRole("group", { name: "cos -> cos", exact: true });
  await group.getByRole("option").filter({ hasText: "element ScaleInput" }).click();
  await shot(page, "foreign-report");
  await openTool(page, "Inspector");
  await panel(page, "Inspector").getByRole("heading", { name: "cos -> cos", exact: true }).waitFor();
  expect(await said.count(), "the offer was taken").toBe(0);
  expect(await page.getByRole("button", { name: /^Import report/ }).count(), "nothing was lost").toBe(0);
  const tab = page.getByRole("tab", { name: "Import report" });
  await tab.focus();
  await tab.press("Delete");
  await file(page, "Notes");
  await notes().getByText("carried, 0 approximated, 0 dropped").waitFor();
  await openTool(page, "Inspector");
});

test("the imported model runs, and the plot of a field shows it", async () => {
  const { page } = studio;
  await observer.runs();
  const drawing = page
    .getByRole("region", { name: "Heat map of vis_f1", exact: true })
    .locator("canvas.plot-heat");
  await drawing.waitFor();
  const before = await drawn(drawing);
  await button(page, "Play").click();
  await observer.until(() => (observer.clock?.tick ?? 0) > 30);
  await find("i1 for vis_f1");
  await type(page, "amplitude", "12");
  await observer.until(
    () => observer.value("i1 for vis_f1", "amplitude") === 12 && observer.max("vis_f1", "activation") > 3,
  );
  await expect.poll(() => drawn(drawing)).not.toBe(before);
  await expect.poll(() => colours(drawing)).toBeGreaterThan(20);
  await shot(page, "foreign-runs");
});

test("elements with spaces and arrows in their names are tuned like others", async () => {
  const { page } = studio;
  await find("cos -> cos");
  await type(page, "factor", "3.5");
  await observer.until(() => observer.value("cos -> cos", "factor") === 3.5);
  await choose(page, "More for factor", "Pin to Sliders");
  await openTool(page, "Sliders");
  const pinned = slider(page, "cos -> cos.factor", "Sliders");
  await pinned.focus();
  await pinned.press("Home");
  const lowest = Number(await pinned.getAttribute("aria-valuemin"));
  await observer.until(() => observer.value("cos -> cos", "factor") === lowest);

  await find("atn_sr -> atn_sr");
  await type(page, "kernel.0.amplitude", "9");
  await observer.until(
    () => observer.value("atn_sr -> atn_sr", "kernel.0.amplitude") === 9 && observer.clock?.busy === "",
  );
  expect(observer.running, "it runs on meanwhile").toBe(true);
});

test("the values of a preset file are one undo step, and values without a match are listed", async () => {
  const { page } = studio;
  await choosePreset("preset.json");
  await observer.until(() => observer.value("atn_sr", "resting_level") === -3);
  expect([observer.value("boost ior_s", "amplitude"), observer.value("i1 for vis_f1", "amplitude")]).toEqual([
    2, 0,
  ]);
  await took()
    .getByText(/^3 values were taken over from preset\.json\. \d+ entries did not match/)
    .waitFor();
  const unmatched = await took().getByRole("listitem").allInnerTexts();
  expect(unmatched).toHaveLength(ELEMENTS - 3 + 1);
  expect(unmatched).toContain("another field: element Field: dropped, the model has no such element");
  expect(unmatched).toContain(
    "ior_s: element Field: dropped, the file has no such element; it keeps its values",
  );
  await shot(page, "foreign-preset");
  await took().getByRole("button", { name: "Keep" }).click();
  await took().waitFor({ state: "detached" });

  await page.keyboard.press("Control+z");
  await observer.until(() => observer.value("atn_sr", "resting_level") === -5);
  expect(observer.value("i1 for vis_f1", "amplitude"), "all of it, in one step").toBe(12);

  await choosePreset("preset.json");
  await observer.until(() => observer.value("atn_sr", "resting_level") === -3);
  await took().getByRole("button", { name: "Undo" }).click();
  await observer.until(() => observer.value("atn_sr", "resting_level") === -5);
  expect(observer.value("i1 for vis_f1", "amplitude")).toBe(12);
});

test("a preset may come from another folder, and an invalid document is refused with a reason", async () => {
  const { page, folder } = studio;
  await file(page, /^Take over values/);
  const dialog = page.getByRole("dialog", { name: "Apply the values of a file" });
  const [chooser] = await Promise.all([
    page.waitForEvent("filechooser"),
    dialog.getByRole("button", { name: /^From elsewhere/ }).click(),
  ]);
  await chooser.setFiles({ name: "own.json", mimeType: "application/json", buffer: Buffer.from(preset()) });
  await took()
    .getByText(/taken over from own\.json/)
    .waitFor();
  await took().getByRole("button", { name: "Undo" }).click();
  await observer.until(() => observer.value("atn_sr", "resting_level") === -5);

  writeFileSync(join(folder, "broken.json"), "{");
  await choosePreset("broken.json");
  await page.getByRole("region", { name: "Messages" }).getByText("broken.json").waitFor();
  await button(page, "Dismiss").click();
  expect(observer.value("atn_sr", "resting_level")).toBe(-5);
});

test("a dropped file of another tool opens", async () => {
  const { page } = studio;
  await observer.ask({ type: "close", discard: true });
  await page.getByRole("heading", { name: "Examples" }).waitFor();
  await drop(page, "dropped.json", "application/json", new TextEncoder().encode(CONTENT));
  await page.getByText("Imported from dropped.json (cosivina): 168 elements").first().waitFor();
  await observer.until(
    () => observer.document?.title === "dropped" && observer.document.elements.length === ELEMENTS,
  );
  await page.getByRole("toolbar", { name: "Run" }).waitFor();
});
