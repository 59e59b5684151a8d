/** Pinned sliders in boxes, equal with those of the panel and with the inspector. */
import type { Locator, Page } from "playwright-core";
import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import {
  box,
  button,
  drag,
  number,
  openEmpty,
  openTool,
  select,
  settled,
  showEverything,
  slider,
} from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;
const ids = new Map<string, string>();

beforeAll(async () => {
  studio = await startStudio();
  observer = await studio.observe();
});

afterAll(() => studio.stop());

// Two fields side by side, each with pins.
beforeEach(async () => {
  const { page } = studio;
  await openEmpty(page, observer);
  for (const [name, x] of [
    ["left", 0],
    ["right", 420],
  ] as const) {
    const { made = [] } = await observer.ask({ type: "add_element", kind: "Field", name, at: [x, 0] });
    ids.set(name, made[0] ?? "");
  }
  await observer.ask({ type: "connect", source: id("left"), target: id("right") });
  await box(page, "right").waitFor();
  await pin(["left", "resting_level"], ["right", "resting_level"], ["left", "noise"], ["left", "tau"]);
  await showEverything(page);
  await observer.runs();
});

const id = (name: string): string => ids.get(name) ?? "";
const pin = (...pins: [string, string][]) =>
  observer.ask({
    type: "arrange",
    layout: { pins: pins.map(([name, parameter]) => ({ element: id(name), parameter })) },
  });
const track = (page: Page, name: string, parameter: string): Locator =>
  box(page, name).getByRole("slider", { name: `${name}.${parameter}`, exact: true });
const field = (page: Page, name: string, parameter: string): Locator =>
  box(page, name).getByRole("textbox", { name: `${name}.${parameter}`, exact: true });
const place = (page: Page, name: string) => settled(page, () => box(page, name).boundingBox());

test("each box has up to two sliders, and is as much higher as they need", async () => {
  const { page } = studio;
  await track(page, "left", "noise").waitFor();
  expect(await box(page, "left").getByRole("slider").count()).toBe(2);
  expect(await box(page, "right").getByRole("slider").count()).toBe(1);
  const [left, right] = [await place(page, "left"), await place(page, "right")];
  const zoom = (left?.width ?? 0) / 156;
  expect(((left?.height ?? 0) - (right?.height ?? 0)) / zoom).toBeCloseTo(24, 0);
  for (const name of ["left", "right"]) {
    const [around, last] = [
      await place(page, name),
      await box(page, name).getByRole("textbox").last().boundingBox(),
    ];
    const [bottom, end] = [around, last].map((rect) => (rect?.y ?? 0) + (rect?.height ?? 0));
    expect(end).toBeLessThanOrEqual(bottom as number);
  }
  await shot(page, "box-pins");
});

test("a drag on a track moves no box, is one step back, and shows in panel, inspector and page", async () => {
  const { page, another } = studio;
  const other = await another();
  await track(other, "left", "resting_level").waitFor();
  await openTool(page, "Sliders");
  const [before, at] = [observer.value("left", "resting_level") as number, await place(page, "left")];
  const steps = observer.document?.undo ?? 0;
  await drag(page, track(page, "left", "resting_level"), 0.9);
  const now = await field(page, "left", "resting_level").inputValue();
  expect(Number(now)).not.toBe(before);
  await observer.until(() => observer.value("left", "resting_level") === Number(now));
  expect(observer.document?.undo).toBe(steps + 1);
  expect(observer.value("right", "resting_level")).toBe(before);
  expect(await place(page, "left")).toEqual(at);
  await expect.poll(() => number(page, "left.resting_level", "Sliders").inputValue()).toBe(now);
  await expect.poll(() => field(other, "left", "resting_level").inputValue()).toBe(now);
  await select(page, "left");
  await expect.poll(() => number(page, "resting_level").inputValue()).toBe(now);
  await button(page, "Undo").click();
  await observer.until(() => observer.value("left", "resting_level") === before);
  await expect.poll(() => field(other, "left", "resting_level").inputValue()).toBe(String(before));
  await expect.poll(() => number(page, "resting_level").inputValue()).toBe(String(before));
  await other.close();
});

test("a number is dragged and typed, and keys change a slider of a selected box that stays", async () => {
  const { page } = studio;
  await select(page, "right");
  const at = await place(page, "right");
  const value = () => observer.value("right", "resting_level") as number;
  const before = value();
  const rect = await field(page, "right", "resting_level").boundingBox();
  const [x, y] = [(rect?.x ?? 0) + 20, (rect?.y ?? 0) + 10];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 20, y, { steps: 5 });
  await page.mouse.up();
  await observer.until(() => value() > before);
  await field(page, "right", "resting_level").fill("-7");
  await page.keyboard.press("Enter");
  await observer.until(() => value() === -7);
  await track(page, "right", "resting_level").focus();
  await page.keyboard.press("ArrowRight");
  await observer.until(() => value() > -7);
  await page.keyboard.press("ArrowDown");
  await observer.until(() => value() === -7);
  expect(await place(page, "right")).toEqual(at);
  expect(observer.value("left", "resting_level")).toBe(before);
  expect(await slider(page, "resting_level").getAttribute("aria-valuetext")).toBe("-7");
});

test("below 90 % the sliders vanish, and the box keeps its height", async () => {
  const { page } = studio;
  await track(page, "left", "noise").waitFor();
  const before = await place(page, "left");
  for (let n = 0; n < 3; n++) await button(page, "Zoom out").click();
  await track(page, "left", "noise").waitFor({ state: "detached" });
  const small = await place(page, "left");
  const share = (rect: typeof small) => (rect?.height ?? 0) / (rect?.width ?? 1);
  expect(share(small)).toBeCloseTo(share(before), 1);
  await shot(page, "box-pins-small");
});
