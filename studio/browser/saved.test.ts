import { existsSync } from "node:fs";
import { join } from "node:path";

import { afterAll, beforeAll, expect, test } from "vitest";

import { obstacles } from "./axe";
import { box, button, select, type } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({ copies: ["examples/selection.json"], file: "selection.json" });
  observer = await studio.observe();
  await observer.runs();
  observer.values("u", "activation");
});

afterAll(() => studio.stop());

const open = () => button(studio.page, "Snapshots and presets").click();
const list = () => studio.page.getByRole("dialog");
const level = () => observer.element("u").values.resting_level;

test("a snapshot is saved, returned to by a click, and deleted", async () => {
  const { page } = studio;
  await box(page, "u").waitFor();
  await observer.ask({ type: "step", n: 250 });
  await observer.until(() => observer.moment("u", "activation") === 250);
  const before = [...observer.values("u", "activation")];
  await open();
  await list().getByRole("button", { name: "Save snapshot" }).click();
  const row = list().getByRole("button", { name: "Return to at 250 ms" });
  await row.waitFor();
  expect(await row.innerText()).toMatch(/250 ms, \d+ kB, saved today at/);
  const file = join(studio.folder, "snapshots", "selection", "at 250 ms.npz");
  expect(existsSync(file)).toBe(true);
  expect(await obstacles(page)).toEqual([]);
  await page.keyboard.press("Escape");
  await observer.ask({ type: "step", n: 30 });
  await observer.until(() => observer.moment("u", "activation") === 280);
  await open();
  await row.click();
  await observer.until(() => observer.moment("u", "activation") === 250);
  expect([...observer.values("u", "activation")]).toEqual(before);
  await list().getByRole("button", { name: "Delete the snapshot at 250 ms" }).click();
  await row.waitFor({ state: "detached" });
  expect(existsSync(file)).toBe(false);
  await page.keyboard.press("Escape");
});

test("a preset is saved and applied by a click", async () => {
  const { page } = studio;
  await select(page, "u");
  await type(page, "resting_level", "-8");
  await observer.until(() => level() === -8);
  await open();
  await list().getByRole("textbox", { name: "Name of the preset" }).fill("deep");
  await list().getByRole("button", { name: "Save preset" }).click();
  await list().getByRole("button", { name: "Apply deep" }).waitFor();
  await list().getByRole("textbox", { name: "Name of the snapshot" }).fill("the start");
  await page.keyboard.press("Enter");
  await list().getByRole("button", { name: "Return to the start" }).waitFor();
  await shot(page, "kept");
  await page.emulateMedia({ colorScheme: "dark" });
  await page.setViewportSize({ width: 640, height: 800 });
  await shot(page, "kept-narrow-dark");
  await page.emulateMedia({ colorScheme: "light" });
  await page.setViewportSize({ width: 1280, height: 800 });
  await page.keyboard.press("Escape");
  await type(page, "resting_level", "-2");
  await observer.until(() => level() === -2);
  await open();
  await list().getByRole("button", { name: "Apply deep" }).click();
  await observer.until(() => level() === -8);
  await page.keyboard.press("Escape");
});
