import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { frameOf, type PlanPoint, toPixels } from "../src/world/planFrame";
import { button, openExample, panel } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

const ITEMS = [1, 2, 3, 4, 5];
// Hues in samples of 2 degrees.
const HUES = { cyan: 92, yellow: 28 };

// A block that satisfies its condition fills the middle of the picture, mm.
const NEAR = 165;

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio();
  observer = await studio.observe();
});

// a second try starts before the lesson too
beforeEach(async () => {
  if (observer.document !== null) await observer.ask({ type: "close", discard: true });
  await openExample(studio.page, "Colour search");
  await observer.runs();
  await observer.ask({ type: "watch_world", on: true });
});

afterAll(() => studio.stop());

const world = () => panel(studio.page, "World");
const swatch = (colour: string) => world().getByRole("button", { name: `${colour} block`, exact: true });
const canvas = () => world().getByRole("img", { name: /^The world from above/ });
const block = (name: string) => observer.world.now.scene?.boxes.find((one) => one.name === name);
const isOn = (path: string) => observer.max(path, "activation") > 0;
/** The hue that the weights of a node have their peak at; NaN without a peak. */
const learned = (item: number) =>
  observer.max(`item ${item}.meaning`, "weights") > 0.5
    ? observer.peak(`item ${item}.meaning`, "weights")
    : Number.NaN;
/** The robot drives for some 20 s of the model's time: minutes on a machine that others use too. */
const drivesUntilOn = (item: number) => observer.until(() => isOn(`item ${item}.node`), 4);
const distance = (name: string) => {
  const [body, at] = [observer.world.now.bodies[0], block(name)];
  return Math.hypot((body?.x ?? Number.NaN) - (at?.x ?? 0), (body?.y ?? 0) - (at?.y ?? 0));
};

/** Show a block until its colour is learned, and take it away; the next node is on afterwards. */
async function show(colour: keyof typeof HUES, item: number): Promise<void> {
  await observer.until(() => isOn(`item ${item}.node`));
  await swatch(colour).click();
  await observer.until(() => !isOn(`item ${item}.node`) && learned(item) >= 0);
  expect(Math.abs(learned(item) - HUES[colour])).toBeLessThan(6);
  await shot(studio.page, `lesson-${item}`);
  await swatch(colour).click();
  await observer.until(() => isOn(`item ${item + 1}.node`));
}

async function dragOnto(colour: string, place: PlanPoint): Promise<void> {
  const [area, from] = [await canvas().boundingBox(), await swatch(colour).boundingBox()];
  const border = observer.world.now.scene?.border;
  if (area === null || from === null || border === undefined) throw new Error("The world is not visible.");
  const { x, y } = toPixels(frameOf(border, area.width, area.height), place);
  const { mouse } = studio.page;
  await mouse.move(from.x + from.width / 2, from.y + from.height / 2);
  await mouse.down();
  await mouse.move(area.x + x, area.y + y, { steps: 8 });
  await mouse.up();
}

test("two colours are taught with the mouse, and their blocks are visited in this order", async () => {
  const { page } = studio;
  await world()
    .getByRole("img", { name: /^Picture of the camera/ })
    .waitFor();
  for (const item of ITEMS) {
    observer.max(`item ${item}.node`, "activation");
    observer.max(`item ${item}.meaning`, "weights");
  }
  await shot(page, "lesson-start");
  await button(page, "Play").click();
  await show("cyan", 1);
  await show("yellow", 2);
  await dragOnto("cyan", { x: -170, y: 60 });
  await observer.until(() => block("cyan 1"));

  // a second try finds the speed of the first
  await page.getByRole("button", { name: /^Speed: / }).click();
  await page.getByRole("dialog").getByRole("slider").press("End");
  await page.keyboard.press("Escape");
  const produce = panel(page, "Sliders").getByRole("switch", { name: "produce" });
  await produce.locator("xpath=..").click(); // its track lies above it
  await expect.poll(() => produce.isChecked()).toBe(true);
  await observer.until(() => isOn("item 1.node"));
  expect(observer.document?.parameters.find(({ name }) => name === "mode")?.value).toBe(1);
  await drivesUntilOn(2);
  expect(distance("cyan 1")).toBeLessThan(NEAR);
  expect(distance("yellow")).toBeGreaterThan(NEAR);
  await shot(page, "lesson-first");
  await drivesUntilOn(3);
  expect(distance("yellow")).toBeLessThan(NEAR);
  await button(page, "Pause").click();
  const sliders = panel(page, "Sliders");
  for (const form of ["slider", "switch"] as const) {
    await sliders.getByRole("button", { name: "More for mode" }).click();
    await page.getByRole("menuitem", { name: `Show as ${form}` }).click();
    await sliders.getByRole(form, { name: "produce" }).waitFor();
  }
  await produce.waitFor();
  await shot(page, "lesson-end");
}, 600_000);
