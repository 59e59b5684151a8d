import { afterAll, beforeAll, expect, test } from "vitest";

import { openPast } from "./past";
import { box, button, choose, drag, drawn, panel } from "./hands";
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

const bar = () => studio.page.getByRole("toolbar", { name: "Replay" });
const thumb = () => bar().getByRole("slider", { name: "Moment" });
const moment = () => bar().getByRole("status", { name: "Moment shown" });
const plot = () => studio.page.getByRole("region", { name: /of u$/ }).locator("canvas").first();

test("the slider is there before a run, and nothing moves when it can be used", async () => {
  const { page } = studio;
  await box(page, "u").waitFor();
  await expect.poll(() => button(page, "Previous frame").isDisabled()).toBe(true);
  const places = async () => {
    const all = [bar(), button(page, "Play"), panel(page, "Architecture"), bar().getByRole("button").last()];
    return JSON.stringify(await Promise.all(all.map((one) => one.boundingBox())));
  };
  const before = await places();
  await openPast(observer, 3);
  await expect.poll(() => button(page, "Previous frame").isDisabled()).toBe(false);
  expect(await places()).toBe(before);
  await button(page, "Previous frame").click();
  await expect.poll(() => moment().innerText()).toMatch(/^2 ms/);
  expect(await places()).toBe(before);
  await button(page, "Live").click();
  await expect.poll(() => moment().innerText()).toBe("");
});

test("a drag pauses the run and shows the past; Play returns to the present", async () => {
  const { page } = studio;
  await observer.ask({ type: "reset" });
  await observer.ask({ type: "speed", factor: 1 });
  await button(page, "Play").click();
  await observer.until(() => observer.time > 1500);
  await drag(page, thumb(), 0.3);
  await observer.until(() => !observer.running);
  await expect
    .poll(() => page.getByRole("timer", { name: "Simulated time" }).innerText())
    .toMatch(/in the past/);
  expect(observer.moment("u", "activation"), "a page of its own").toBe(observer.time);
  const there = await drawn(plot());
  await shot(page, "replay");
  await drag(page, thumb(), 0);
  await expect.poll(() => drawn(plot())).not.toBe(there);
  await button(page, "Play").click();
  await observer.until(() => observer.running);
  await expect.poll(() => moment().innerText()).toBe("");
  await button(page, "Pause").click();
  await observer.until(() => !observer.running);
});

test("keys move by a frame and to both ends", async () => {
  const { page } = studio;
  await openPast(observer, 5);
  const said = (text: RegExp) => expect.poll(() => moment().innerText()).toMatch(text);
  await page.locator("body").press("ArrowLeft");
  expect(await moment().innerText(), "keys of the past do nothing at present").toBe("");
  await button(page, "Previous frame").click();
  await said(/^4 ms\s+frame 5 of 6/);
  await page.keyboard.press("ArrowLeft");
  await said(/^3 ms/);
  await page.keyboard.press("ArrowRight");
  await said(/^4 ms/);
  await page.keyboard.press("Home");
  await said(/^0 ms\s+frame 1 of 6/);
  await page.keyboard.press("End");
  await said(/^5 ms/);
  await thumb().press("ArrowLeft");
  await said(/^4 ms/);
});

test("a replay plays backward and forward until the end", async () => {
  const { page } = studio;
  await openPast(observer, 40);
  await bar().getByLabel("Speed of the replay").selectOption("0.1");
  await button(page, "Replay backward").click();
  await button(page, "Stop replay").waitFor();
  await expect.poll(() => moment().innerText()).toMatch(/^0 ms/);
  await button(page, "Replay backward").waitFor();
  await button(page, "Replay forward").click();
  await expect.poll(() => moment().innerText()).toMatch(/^40 ms/);
  await button(page, "Replay forward").waitFor();
});

test("the run continues from the moment shown", async () => {
  const { page } = studio;
  await openPast(observer, 30);
  expect(await button(page, "Run from here").isDisabled(), "the present is no moment of the past").toBe(true);
  await observer.until(() => observer.moment("u", "activation") === 30);
  const later = [...observer.values("u", "activation")];
  await button(page, "First frame").click();
  await expect.poll(() => moment().innerText()).toMatch(/^0 ms/);
  await shot(page, "replay-from");
  await page.setViewportSize({ width: 640, height: 800 });
  await shot(page, "replay-from-narrow");
  await page.setViewportSize({ width: 1280, height: 800 });
  await observer.ask({ type: "speed", factor: 0.01 });
  await button(page, "Run from here").click();
  await observer.until(() => observer.running && observer.time < 30);
  await expect.poll(() => moment().innerText()).toBe("");
  await button(page, "Pause").click();
  await observer.until(() => !observer.running);
  const left = 30 - observer.time;
  expect(left).toBeGreaterThan(0);
  await observer.ask({ type: "step", n: left });
  await observer.until(() => observer.moment("u", "activation") === 30);
  expect([...observer.values("u", "activation")], "the same noise").toEqual(later);
  await observer.ask({ type: "speed", factor: 1 });
});

test("another page stays at the present", async () => {
  const { page } = studio;
  await openPast(observer, 40);
  const other = await studio.another();
  const shown = other.getByRole("status", { name: "Moment shown" });
  await box(other, "u").waitFor();
  await button(page, "First frame").click();
  await expect.poll(() => moment().innerText()).toMatch(/^0 ms/);
  expect(await shown.innerText()).toBe("");
  await other.close();
});

test("a time course marks the moment with a line", async () => {
  const { page } = studio;
  await openPast(observer, 40);
  await choose(page, "Menu of this plot", "Time course");
  const course = () =>
    drawn(page.getByRole("region", { name: "Time course of u" }).locator("canvas").first());
  await expect.poll(course).toBeTruthy();
  await button(page, "Previous frame").click();
  await expect.poll(() => moment().innerText()).toMatch(/^39 ms/);
  const later = await course();
  await button(page, "First frame").click();
  await expect.poll(() => moment().innerText()).toMatch(/^0 ms/);
  await expect.poll(course).not.toBe(later);
  await shot(page, "replay-course");
});

test("the slider marks the time with fewer frames, where older ones were removed", async () => {
  const small = await startStudio({
    copies: ["examples/selection.json"],
    file: "selection.json",
    files: {
      "small_ring.py":
        "from deodar_studio.live.ring import StateRing\nStateRing.__init__.__defaults__ = (60.0, 40_000)\n",
    },
    imports: ["small_ring"],
  });
  try {
    const other = await small.observe();
    await other.runs();
    await box(small.page, "u").waitFor();
    await openPast(other, 60);
    await small.page.getByTitle(/^Before \d+ ms some frames were removed to save memory$/).waitFor();
    await shot(small.page, "replay-thinned");
  } finally {
    await small.stop();
  }
});
