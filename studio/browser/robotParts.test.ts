/** From an empty document to a robot's eyes and wheels, by the mouse alone. */
import { afterAll, beforeAll, expect, test } from "vitest";

import { box, button, openEmpty, option, panel, place, showEverything } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio();
  observer = await studio.observe();
  await openEmpty(studio.page, observer);
});

afterAll(() => studio.stop());

async function add(name: string, across: number, down: number): Promise<void> {
  const at = await place(studio.page, across, down);
  await studio.page.mouse.dblclick(at.x, at.y);
  await option(studio.page, name).click();
  await studio.page.getByRole("dialog").waitFor({ state: "detached" });
}

test("a field over a new axis, a camera, a sensor and a motor of the arena have no problem", async () => {
  const { page } = studio;
  const inspector = panel(page, "Inspector");
  await button(page, "Add an axis").click();
  const row = inspector.getByRole("form", { name: "New axis" });
  for (const [word, text] of Object.entries({
    name: "angle",
    from: "-180",
    to: "180",
    samples: "36",
    unit: "deg",
  }))
    await row.getByRole("textbox", { name: `${word} of the new axis` }).fill(text);
  await row.getByRole("button", { name: "Make" }).click();
  await observer.until(() => observer.document?.axes.length === 1);

  const wanted = [
    ["Field, 2-D", "field", 0.15, 0.15],
    ["Camera, 16 x 12 x 3 samples", "camera", 0.6, 0.15],
    ["Infrared, 8 samples", "infrared", 0.15, 0.6],
    ["Left wheel", "left", 0.6, 0.6],
  ] as const;
  for (const [title, name, across, down] of wanted) {
    await add(title, across, down);
    await box(page, name).waitFor();
    expect(observer.document?.problems.filter(({ severity }) => severity === "problem")).toEqual([]);
  }
  expect(observer.value("field", "axes")).toEqual(["angle", "x"]);
  await showEverything(page);
  await button(page, "World: Arena: an example; choose another one").waitFor();
  await observer.runs();
  await shot(page, "robot-parts");
  expect(await page.getByRole("img", { name: /^Problem: / }).count()).toBe(0);
  await button(page, "Play").click();
  await observer.until(() => observer.time > 0);
});
