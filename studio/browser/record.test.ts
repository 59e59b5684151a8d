import { rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { afterAll, beforeAll, expect, test } from "vitest";

import { obstacles } from "./axe";
import { box, button, choose, colours, drag, drawn, panel, select } from "./hands";
import { runPython } from "./server";
import { shot, startStudio, type Studio } from "./studio";

const part = (kind: string, id: string, more: object) => ({ kind, id, axes: [], ...more });
const DRIVING = {
  deodar: 1,
  name: "driving",
  dt: 64,
  axes: { of: { name: "of", lower: 0, upper: 2, samples: 3 } },
  elements: {
    "go left": part("Boost", "00000001", { amplitude: 1000 }),
    left: part("Motor", "00000002", { motor: "left" }),
    "go right": part("Boost", "00000003", { amplitude: 800 }),
    right: part("Motor", "00000004", { motor: "right" }),
    pose: part("Sensor", "00000005", { axes: ["of"], sensor: "pose" }),
  },
  connections: [
    { source: "go left.output", target: "left.input" },
    { source: "go right.output", target: "right.input" },
  ],
};

let studio: Studio;

const run = (...words: string[]) =>
  runPython(["-m", "deodar", "run", "selection.json", "--no-progress", ...words], studio.folder, {
    DEODAR_STATE: studio.state,
  });

beforeAll(async () => {
  studio = await startStudio({ copies: ["examples/selection.json"] });
  const how = ["--duration", "600", "--record", "u.activation", "u.output", "--every", "2"];
  await run(...how, "--out", "single");
  await run(...how, "--out", "trials", "--trials", "3", "--sweep", "left.amplitude=2,6");
});

afterAll(() => studio.stop());

const bar = () => studio.page.getByRole("toolbar", { name: "Replay" });
const moment = () => bar().getByRole("status", { name: "Moment shown" });
const said = (text: RegExp) => expect.poll(() => moment().innerText()).toMatch(text);
const plot = () => studio.page.getByRole("region", { name: /of u$/ }).locator("canvas").first();

async function open(name: string): Promise<void> {
  const { page } = studio;
  await page.keyboard.press("Control+o");
  const dialog = page.getByRole("dialog");
  await dialog.getByRole("button", { name, exact: false }).click();
  await dialog.waitFor({ state: "detached" });
  await page.getByRole("toolbar", { name: "Record" }).waitFor();
}

test("a record opens from the list of files, and the slider moves every plot and box", async () => {
  const { page } = studio;
  await open("single");
  await said(/^0 ms\s+frame 1 of 301/);
  expect(await page.getByRole("heading", { level: 1 }).innerText()).toBe("selection");
  await box(page, "u").waitFor();
  const first = await drawn(plot());
  expect(await obstacles(page)).toEqual([]);
  await drag(page, bar().getByRole("slider", { name: "Moment" }), 0.75);
  await said(/^4[45]\d ms/);
  await expect.poll(() => drawn(plot())).not.toBe(first);
  await shot(page, "record");
  await page.keyboard.press("End");
  await said(/^600 ms\s+frame 301 of 301/);
  await page.keyboard.press("ArrowLeft");
  await said(/^598 ms/);
  await page.keyboard.press("Home");
  await said(/^0 ms/);
});

test("a click on the number of a wire of a record selects the wire, and nothing changes it", async () => {
  const { page } = studio;
  const wire = page.locator(".react-flow__edge").first();
  const chip = page.getByRole("spinbutton", { name: /^Strength, / }).first();
  await wire.hover({ force: true });
  await chip.click();
  const card = page.locator(".graph-wire-card");
  await card.waitFor();
  expect(await chip.count(), "the number is not typed").toBe(1);
  expect(await card.getByRole("slider").count(), "a slider without a thumb").toBe(0);
  expect(await card.innerText()).toContain("A record is not changed; its model can be.");
  await shot(page, "record-wire");
  await page.keyboard.press("Escape");
});

test("Space plays a record to its end at the chosen speed, and backward", async () => {
  const { page } = studio;
  await bar().getByLabel("Speed of the replay").selectOption("0.5");
  await page.locator("main").press("Space");
  await button(page, "Stop replay").waitFor();
  await said(/^600 ms/);
  await bar().getByLabel("Speed of the replay").selectOption("5");
  await button(page, "Replay backward").click();
  await said(/^0 ms/);
});

test("a port that was not recorded says so, in its box and in its plot", async () => {
  const { page } = studio;
  await box(page, "left").dblclick();
  const lost = page.getByRole("region", { name: /of left$/ }).getByRole("status");
  await expect.poll(() => lost.innerText()).toMatch(/^left\.output was not recorded/);
  await shot(page, "record-lost");
});

test("a time course of the whole record is drawn, with a line at the moment", async () => {
  const { page } = studio;
  await select(page, "u");
  const region = page.getByRole("region", { name: /of u$/ });
  await region.getByRole("button", { name: "Menu of this plot" }).click();
  await page.getByRole("menuitem", { name: "Time course", exact: true }).click();
  const course = () =>
    drawn(page.getByRole("region", { name: "Time course of u" }).locator("canvas").first());
  await bar().getByRole("slider", { name: "Moment" }).press("Home");
  await said(/^0 ms/);
  await expect.poll(course).toBeTruthy();
  const before = await course();
  await bar().getByRole("slider", { name: "Moment" }).press("End");
  await said(/^600 ms/);
  await expect.poll(course).not.toBe(before);
  await shot(page, "record-course");
});

test("the inspector shows the parameters of a record without changing them", async () => {
  const { page } = studio;
  await panel(page, "Inspector").getByText("Parameters of the record").waitFor();
  expect(await panel(page, "Inspector").locator("[inert]").count()).toBe(1);
});

test("the trial and the point of a sweep are chosen", async () => {
  const { page } = studio;
  await open("trials");
  await said(/^0 ms/);
  await page.keyboard.press("End");
  await said(/^600 ms/);
  const record = page.getByRole("toolbar", { name: "Record" });
  const before = await drawn(plot());
  await record.getByLabel("trial").selectOption("2");
  await expect.poll(() => drawn(plot())).not.toBe(before);
  const after = await drawn(plot());
  expect(await button(page, "Run from here").isDisabled()).toBe(true);
  await record.getByLabel("left.amplitude").selectOption("6");
  await expect.poll(() => drawn(plot())).not.toBe(after);
  await shot(page, "record-trials");
});

test("a page shows its moment and its trial again after the connection was lost", async () => {
  const file = join(studio.folder, "trials");
  const second = await startStudio({
    file,
    expected: [/WebSocket connection to .* failed/, /ERR_CONNECTION_REFUSED/],
  });
  try {
    const { page } = second;
    const shown = page.getByRole("status", { name: "Moment shown" });
    const canvas = page.getByRole("region", { name: /of u$/ }).locator("canvas").first();
    await page.getByRole("slider", { name: "Moment" }).press("End");
    await expect.poll(() => shown.innerText()).toMatch(/^600 ms/);
    const first = await drawn(canvas);
    await page.getByRole("toolbar", { name: "Record" }).getByLabel("trial").selectOption("2");
    await expect.poll(() => drawn(canvas)).not.toBe(first);
    await page.waitForTimeout(300);
    const before = await drawn(canvas);
    await second.restart();
    await page.getByText("Connection lost").waitFor({ state: "detached" });
    await expect.poll(() => shown.innerText()).toMatch(/^600 ms/);
    await expect.poll(() => drawn(canvas)).toBe(before);
    expect(await page.getByRole("toolbar", { name: "Record" }).getByLabel("trial").inputValue()).toBe("2");
  } finally {
    await second.stop();
  }
});

test("the model of a record runs as a copy of its document", async () => {
  const { page } = studio;
  await button(page, "Run its model").click();
  await button(page, "Play").click();
  await button(page, "Pause").click();
  await choose(page, "File menu", "Close");
});

test("a run continues from a moment of its record", async () => {
  const { page } = studio;
  await open("single");
  await said(/^0 ms/);
  await page.keyboard.press("End");
  await said(/^600 ms/);
  await button(page, "Run from here").click();
  await page.getByRole("toolbar", { name: "Record" }).waitFor({ state: "detached" });
  await button(page, "Pause").click();
  await button(page, "Play").waitFor();
  const time = page.getByRole("timer", { name: "Simulated time" });
  // the state at which it paused is published after the pause
  await expect.poll(() => time.innerText()).toMatch(/^([6-9]\d\d ms|[1-9]\d*\.\d+ s)/);
  await shot(page, "record-continued");
  await choose(page, "File menu", "Close");
});

test("the world of a record shows its body, or states that it was not recorded", async () => {
  const { page } = studio;
  writeFileSync(join(studio.folder, "driving.json"), JSON.stringify(DRIVING));
  const drive = (out: string, ...ports: string[]) =>
    runPython(
      ["-m", "deodar", "run", "driving.json", "--no-progress", "--duration", "6400", "--out", out]
        .concat(["--world", "arena:blocks", "--record"])
        .concat(ports),
      studio.folder,
      { DEODAR_STATE: studio.state },
    );
  await drive("drive", "pose.output");
  await drive("blind", "left.input");
  const world = panel(page, "World");
  await open("drive");
  const canvas = world.getByRole("img", { name: /^The world from above/ });
  await canvas.waitFor();
  await expect.poll(() => colours(canvas)).toBeGreaterThan(4);
  const start = await drawn(canvas);
  await page.keyboard.press("End");
  await said(/^6\.400 s/);
  await expect.poll(() => drawn(canvas)).not.toBe(start);
  await shot(page, "record-world");
  await open("blind");
  await world.getByText("The position of the body was not recorded").waitFor();
  await choose(page, "File menu", "Close");
});

test("a damaged record opens as far as it is sound, or shows one error", async () => {
  const { page } = studio;
  rmSync(join(studio.folder, "single", "record.zarr", "zarr.json"));
  await page
    .getByRole("list", { name: "Recent files" })
    .getByRole("button", { name: /^single/ })
    .click();
  await page.getByText("There is one problem.").waitFor();
  await page.getByText("is a folder without a record in it").waitFor();
});
