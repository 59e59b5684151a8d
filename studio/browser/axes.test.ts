import type { Locator } from "playwright-core";
import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { obstacles } from "./axe";
import { box, button, openEmpty, option, panel, place, select } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio();
  observer = await studio.observe();
});

beforeEach(() => openEmpty(studio.page, observer));

afterAll(() => studio.stop());

const inspector = (): Locator => panel(studio.page, "Inspector");
const keys = (): string => (observer.document?.axes ?? []).map(({ key }) => key).join();
const undo = (): number => observer.document?.undo ?? -1;
const problems = (): number =>
  (observer.document?.problems ?? []).filter(({ severity }) => severity === "problem").length;

/** Fill the row of a new axis. */
async function fill(values: Record<string, string>): Promise<void> {
  const row = inspector().getByRole("form", { name: "New axis" });
  for (const [word, text] of Object.entries(values))
    await row.getByRole("textbox", { name: `${word} of the new axis` }).fill(text);
}

/** Add an element at a place of the empty ground. */
async function add(name: string, across: number, down: number): Promise<void> {
  const at = await place(studio.page, across, down);
  await studio.page.mouse.dblclick(at.x, at.y);
  await option(studio.page, name).click();
}

test("an axis is made, changed and removed in the document's section, each as one step of undo", async () => {
  const { page } = studio;
  const before = undo();
  await button(page, "Add an axis").click();
  await fill({ name: "angle", from: "-180", to: "180", samples: "0", unit: "deg" });
  await inspector().getByRole("checkbox", { name: "periodic new axis" }).check();
  await inspector().getByRole("button", { name: "Make" }).click();
  await inspector().getByRole("alert").waitFor();
  await fill({ samples: "72" });
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "axes-new");
  await page.keyboard.press("Enter");
  await observer.until(() => keys() === "angle");
  const made = {
    key: "angle",
    name: "angle",
    lower: -180,
    upper: 180,
    samples: 72,
    periodic: true,
    unit: "deg",
  };
  expect(observer.document?.axes[0]).toEqual(made);
  expect(undo()).toBe(before + 1);

  await inspector().getByTitle("Edit the axis angle").click();
  const samples = page.getByRole("textbox", { name: "Samples of the axis angle" });
  await samples.fill("36");
  await samples.press("Enter");
  await observer.until(() => observer.document?.axes[0]?.samples === 36);
  await page.getByText("No element has this axis.").waitFor();
  await page.getByRole("button", { name: "Remove", exact: true }).click();
  await observer.until(() => keys() === "");
  expect(undo()).toBe(before + 3);
  await page.keyboard.press("Escape");

  await page.getByRole("combobox", { name: "Time unit" }).click();
  await page.getByRole("option", { name: "s", exact: true }).click();
  await observer.until(() => observer.document?.time_unit === "s");
  expect(undo()).toBe(before + 4);
});

test("fields over one, two and three dimensions bring axes, or take those of the document", async () => {
  const { page } = studio;
  await add("Field, 2-D", 0.2, 0.2);
  await box(page, "field").waitFor();
  await observer.until(() => keys() === "x,y");
  await add("Field, 1-D", 0.7, 0.2);
  await box(page, "field2").waitFor();
  await add("Field, 3-D", 0.2, 0.7);
  await box(page, "field3").waitFor();
  await observer.until(() => observer.document?.elements.length === 3);
  const axesOf = (path: string) => observer.value(path, "axes");
  expect([axesOf("field"), axesOf("field2"), axesOf("field3")]).toEqual([["x", "y"], ["x"], ["x", "y", "z"]]);
  await page.keyboard.press("/");
  await page.keyboard.type("fi");
  await page.keyboard.press("Enter");
  await observer.until(() => observer.document?.elements.length === 4);
  expect(axesOf("field4")).toEqual(["x"]);
  expect(problems()).toBe(0);
});

test("a field gets a new axis in its menu; of two axes of one name the lists show what differs", async () => {
  const { page } = studio;
  await add("Field, 1-D", 0.3, 0.3);
  await box(page, "field").waitFor();
  await select(page, "field");
  const before = undo();
  await inspector().getByRole("combobox", { name: "axes", exact: true }).click({ force: true });
  await page.getByRole("option", { name: "+ New axis" }).click();
  await fill({ name: "y", to: "20", samples: "41" });
  await page.keyboard.press("Enter");
  await observer.until(() => keys() === "x,y");
  expect(observer.value("field", "axes")).toEqual(["x", "y"]);
  expect(undo()).toBe(before + 1);
  await observer.ask({
    type: "add_axis",
    axis: { name: "y", lower: 0, upper: 20, samples: 21, periodic: false, unit: "" },
  });
  await observer.until(() => keys() === "x,y,y_2");
  await inspector().getByRole("combobox", { name: "axes", exact: true }).click({ force: true });
  await page.getByRole("option", { name: "y_2 (y): 0 to 20, 21 samples" }).waitFor();
  await shot(page, "axes-menu");
  await page.keyboard.press("Escape");
  await inspector().getByTitle("Edit the axis y", { exact: true }).click();
  await page.getByRole("button", { name: "Remove, also from the element" }).click();
  await observer.until(() => keys() === "x,y");
  expect(observer.value("field", "axes")).toEqual(["x"]);
  expect(problems()).toBe(0);
});
