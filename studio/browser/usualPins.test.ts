/** Sliders by the button of the empty panel, and by dragging a parameter of the inspector. */
import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { box, button, number, openTool, panel, reopen, select, slider, type } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({ copies: ["examples/selection.json"], file: "selection.json" });
  observer = await studio.observe();
});

afterAll(() => studio.stop());

beforeEach(() => reopen(studio.page, observer, "selection.json"));

const pinned = (): string[] =>
  ((observer.document?.layout["pins"] ?? []) as { parameter: string }[]).map(({ parameter }) => parameter);
const row = (parameter: string) =>
  panel(studio.page, "Inspector").getByRole("group", { name: parameter, exact: true }).locator(".row-name");
const tab = () => studio.page.getByRole("tab", { name: "Sliders", exact: true });

test("the usual five are pinned as one step of undo, on both pages and in the boxes", async () => {
  const { page, another } = studio;
  const other = await another();
  for (const one of [page, other]) await openTool(one, "Sliders");
  await panel(page, "Sliders").getByText("No sliders yet.").waitFor();
  await shot(page, "usual-pins-none");
  await button(page, "Pin the usual five").click();
  const paths = ["u.resting_level", "u.kernel.0.amplitude", "left.amplitude", "right.amplitude"];
  for (const path of paths) {
    await slider(page, path, "Sliders").waitFor();
    await slider(other, path, "Sliders").waitFor();
  }
  expect(pinned()).toHaveLength(5);
  await shot(page, "usual-pins");
  await type(page, "left.amplitude", "7", "Sliders");
  await observer.until(() => observer.value("left", "amplitude") === 7);
  await expect.poll(() => number(other, "left.amplitude", "Sliders").inputValue()).toBe("7");
  await button(page, "Undo").click();
  await observer.until(() => observer.value("left", "amplitude") !== 7);
  expect(pinned()).toHaveLength(5);
  await button(page, "Undo").click();
  await observer.until(() => pinned().length === 0);
  expect(observer.document?.undo).toBe(0);
  await panel(other, "Sliders").getByText("No sliders yet.").waitFor();
  await other.close();
});

test("a parameter is dragged to the tab, which opens, and into the panel", async () => {
  const { page } = studio;
  await select(page, "u");
  await row("resting_level").dragTo(tab());
  await observer.until(() => pinned().length === 1);
  await slider(page, "u.resting_level", "Sliders").waitFor();
  expect(observer.document?.undo).toBe(1);
  await openTool(page, "Inspector");
  await row("noise").hover();
  await page.mouse.down();
  await tab().hover();
  await tab().hover();
  await slider(page, "u.resting_level", "Sliders").hover();
  await slider(page, "u.resting_level", "Sliders").hover();
  await page.mouse.up();
  await observer.until(() => pinned().length === 2);
  expect(pinned()).toEqual(["resting_level", "noise"]);
  await box(page, "u").waitFor();
  await page.keyboard.press("Control+z");
  await observer.until(() => pinned().length === 1);
});
