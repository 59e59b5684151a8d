import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { beside, button, select, slider, typed } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({ copies: ["examples/selection.json"], file: "selection.json" });
  observer = await studio.observe();
  await observer.runs();
});

// Each test begins at the start of a paused run in real time.
beforeEach(async () => {
  await observer.ask({ type: "pause" });
  await observer.ask({ type: "speed", factor: 1 });
  await observer.ask({ type: "reset" });
  await observer.until(() => !observer.running && observer.time === 0);
  await button(studio.page, "Play").waitFor();
  await expect.poll(said).toMatch(/^0 ms\s+step 0$/);
});

afterAll(() => studio.stop());

const timer = () => studio.page.getByRole("timer", { name: "Simulated time" });
const said = () => timer().innerText();

test("play runs, pause stops, and time and factor are visible", async () => {
  const { page } = studio;
  await button(page, "Play").click();
  await button(page, "Pause").waitFor();
  await observer.until(() => observer.time > 100);
  await expect.poll(said).toMatch(/^[1-9][\d.\u2009]* m?s\s+step [1-9]/);
  const factor = page.getByLabel("Speed measured");
  await expect.poll(() => factor.innerText()).toMatch(/^×(?!0\.00)\d/);
  await shot(page, "run");

  await button(page, "Pause").click();
  await button(page, "Play").waitFor();
  await observer.until(() => !observer.running);
  await expect.poll(() => factor.innerText()).toMatch(/^×–/);
  // requests during a pause change nothing
  await observer.ask({ type: "list_folder" });
  const { time } = observer;
  await observer.ask({ type: "list_folder" });
  expect(observer.time).toBe(time);
  await expect
    .poll(async () => (await said()).replaceAll("\u2009", ""))
    .toMatch(new RegExp(`step ${observer.clock?.tick}$`));
});

test("the buttons take single steps and several steps", async () => {
  const { page } = studio;
  await button(page, "Step").click();
  await observer.until(() => observer.clock?.tick === 1);
  await page.keyboard.press(".");
  await observer.until(() => observer.clock?.tick === 2);
  expect(observer.running).toBe(false);

  await beside(page, "Run settings", (settings) =>
    typed(settings.getByRole("textbox", { name: "Steps at a time" }), "50"),
  );
  await button(page, "50 steps").click();
  await observer.until(() => observer.clock?.tick === 52);
  await button(page, "Run settings").click();
  const settings = page.getByRole("dialog");
  await settings.getByRole("textbox", { name: "Steps at a time" }).fill("1");
  await page.getByRole("heading", { name: "Document parameters" }).click();
  await settings.waitFor({ state: "detached" });
  await button(page, "Step").waitFor();
});

test("settings stay open where text is selected past their edge, and arrow keys step a draft", async () => {
  const { page } = studio;
  await button(page, "Run settings").click();
  const settings = page.getByRole("dialog");
  const steps = settings.getByRole("textbox", { name: "Steps at a time" });
  await steps.fill("77");
  const [from, edge] = [await steps.boundingBox(), await settings.boundingBox()];
  if (from === null || edge === null) throw new Error("The settings are not visible.");
  await page.mouse.move(from.x + 30, from.y + from.height / 2);
  await page.mouse.down();
  await page.mouse.move(edge.x - 60, from.y, { steps: 4 });
  await page.mouse.up();
  expect(await steps.inputValue()).toBe("77");
  await page.keyboard.press("Escape");
  const undo = observer.document?.undo ?? 0;
  await button(page, "Run settings").click();
  const dt = settings.getByRole("textbox", { name: "Time step dt" });
  await dt.focus();
  for (let n = 0; n < 5; n++) await page.keyboard.press("ArrowUp");
  expect(await dt.inputValue()).toBe("1.5");
  await page.keyboard.press("Enter");
  await observer.until(() => observer.clock?.dt === 1.5);
  expect(observer.document?.undo).toBe(undo + 1);
  await page.keyboard.press("Escape");
  await settings.waitFor({ state: "detached" });
  await page.keyboard.press("Control+z");
  await observer.until(() => observer.clock?.dt === 1);
});

test("reset returns to the start; another seed gives another run, the same seed the same run", async () => {
  const { page } = studio;
  const run = async (): Promise<number[]> => {
    await observer.ask({ type: "step", n: 60 });
    await observer.until(() => observer.clock?.tick === 60 && Math.abs(observer.max("u", "activation")) > 0);
    await observer.until(() => observer.moment("u", "activation") === 60);
    return [...observer.values("u", "activation")];
  };
  const first = await run();
  await button(page, "Reset").click();
  await observer.until(() => observer.time === 0);
  expect(await run()).toEqual(first);

  await beside(page, "Run settings", async (settings) => {
    await typed(settings.getByRole("textbox", { name: "Seed of the noise" }), "7");
    await settings.getByText("Takes effect with the next reset.").waitFor();
    await settings.getByRole("button", { name: "Reset" }).click();
  });
  await observer.until(() => observer.clock?.seed === 7 && observer.time === 0);
  expect(await run()).not.toEqual(first);

  await beside(page, "Run settings", async (settings) => {
    await settings.getByRole("button", { name: "New seed" }).click();
    await typed(settings.getByRole("textbox", { name: "Seed of the noise" }), "0");
  });
  await page.keyboard.press("Shift+R");
  await observer.until(() => observer.clock?.seed === 0 && observer.time === 0);
  expect(await run()).toEqual(first);
});

test("the speed ranges from slow motion to full speed", async () => {
  const { page } = studio;
  await beside(page, "Speed: 1×", (speed) => speed.getByRole("slider", { name: "Speed" }).press("Home"));
  await observer.until(() => observer.clock?.speed === 0.01);
  await button(page, "Speed: 0.01×").waitFor();
  await button(page, "Play").click();
  await observer.until(() => observer.running && observer.time > 0);
  await beside(page, "Speed: 0.01×", (speed) => speed.getByRole("slider", { name: "Speed" }).press("End"));
  await observer.until(() => observer.clock?.speed === null);
  await button(page, "Speed: max").waitFor();
  const { time } = observer;
  await observer.until(() => observer.time > time + 1000);
  await expect.poll(() => page.getByLabel("Speed measured").innerText()).toMatch(/^×(?!0\.00)\d/);
});

test("another time step is stored in the document and keeps the state", async () => {
  const { page } = studio;
  await observer.ask({ type: "step", n: 20 });
  await observer.until(() => observer.time === 20);
  await beside(page, "Run settings", async (settings) => {
    const step = settings.getByRole("textbox", { name: "Time step dt" });
    await step.fill("0.5");
    await step.press("Enter");
    await observer.until(() => observer.clock?.dt === 0.5 && observer.document?.dt === 0.5);
    expect(observer.time).toBe(20);
    await step.fill("50");
    await step.press("Enter");
    await settings.getByRole("alert").getByText("longer than the time constant").waitFor();
    await shot(page, "run-settings-refused");
  });
  expect(observer.clock?.dt).toBe(0.5);
  await observer.ask({ type: "step", n: 2 });
  await observer.until(() => observer.time === 21);
  await page.keyboard.press("Control+z");
  await observer.until(() => observer.clock?.dt === 1 && observer.document?.dt === null);
});

test("the keys of the run work, and the help lists them", async () => {
  const { page } = studio;
  // Space would press the button that has the focus
  await page.evaluate(() => (document.activeElement as HTMLElement | null)?.blur());
  await page.keyboard.press("?");
  const help = page.getByRole("dialog", { name: "Keys and mouse" });
  await help.getByText("Play or pause").waitFor();
  await shot(page, "help");
  await page.keyboard.press("Escape");
  await help.waitFor({ state: "detached" });
  await page.keyboard.press("Space");
  await observer.until(() => observer.running && observer.time > 0);
  await select(page, "u");
  await slider(page, "tau").focus();
  await page.keyboard.press("Space");
  await observer.until(() => !observer.running);
  await page.keyboard.press("Shift+R");
  await observer.until(() => observer.time === 0);
});
