import { type ChildProcess, spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import { afterAll, beforeAll, expect, test } from "vitest";

import { findings, smallTargets } from "./axe";
import { button, panel, showView } from "./hands";
import type { Observer } from "./observer";
import { python } from "./server";
import { shot, startStudio, type Studio } from "./studio";

const AT = `tcp/127.0.0.1:${20_000 + Math.floor(Math.random() * 10_000)}`;
const axisless = (kind: string, id: string, more: object) => ({ kind, id, axes: [], ...more });
const DRIVING = {
  deodar: 1,
  name: "driving",
  dt: 64,
  axes: {},
  elements: {
    "go left": axisless("Boost", "00000001", { amplitude: 100 }),
    left: axisless("Motor", "00000002", { motor: "left" }),
    touch: axisless("Sensor", "00000003", { sensor: "touching" }),
  },
  connections: [{ source: "go left.output", target: "left.input" }],
};

// robot and studio find the key of the port in it
const STATE = mkdtempSync(join(tmpdir(), "deodar-robot-"));

let robot: ChildProcess;
let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  const words = ["serve", "arena:blocks", "--at", AT, "--name", "epuck", "--clock", "live"];
  robot = spawn(python(), ["-m", "deodar", ...words], {
    stdio: ["ignore", "pipe", "inherit"],
    env: { ...process.env, DEODAR_STATE: STATE },
  });
  await new Promise((resolve) => robot.stdout?.once("data", resolve));
  studio = await startStudio({
    files: { "driving.json": JSON.stringify(DRIVING) },
    file: "driving.json",
    state: STATE,
    words: ["--world", `zenoh:epuck, at=${AT}, patience=20`],
  });
  observer = await studio.observe();
  await observer.runs();
});

afterAll(async () => {
  await studio.stop();
  robot.kill();
  rmSync(STATE, { recursive: true, force: true });
});

const world = () => panel(studio.page, "World");
const drive = async () => {
  await observer.ask({ type: "play" });
  await observer.until(() => observer.running);
};

test("the panel of the world shows the link with the robot, and its button stops it", async () => {
  const { page } = studio;
  await drive();
  await world()
    .getByText(/^epuck: last message \d\.\d s ago, \d+ lost, round trip \d+\.\d ms$/)
    .waitFor();
  await button(page, "Stop").click();
  await observer.until(() => !observer.running);
  expect(await smallTargets(page)).toEqual([]);
  expect(await findings(page)).toEqual([]);
});

test("Escape stops the robot wherever the focus is", async () => {
  const { page } = studio;
  await drive();
  await page.keyboard.press("Escape");
  await observer.until(() => !observer.running);
  await drive();
  await page.keyboard.press("Control+k");
  await page.getByRole("dialog").waitFor();
  await page.keyboard.press("Escape");
  await observer.until(() => !observer.running);
});

const limits = () => studio.page.getByRole("button", { name: /^left: / });
const field = (name: string) => studio.page.getByRole("textbox", { name, exact: true });
const enter = async (name: string, text: string) => {
  await field(name).fill(text);
  await field(name).press("Enter");
};

test("range and speed of each motor are beside the stop in every view, and are made narrower", async () => {
  const { page } = studio;
  for (const view of ["Run", "Experiment", "Robot", "Build"] as const) {
    await showView(page, view);
    await button(page, "Stop").waitFor();
    await limits().getByText("left: any value").waitFor();
    await limits().getByText("right: any value").waitFor();
  }
  await limits().click();
  await enter("left, from", "-4");
  await enter("left, to", "4");
  await limits().getByText("left: -4 to 4").waitFor();
  await page.getByRole("group", { name: "left" }).getByLabel("change a second").fill("50");
  await page.keyboard.press("Enter");
  await limits()
    .getByText(/left: -4 to 4.*, at most 50 a second/)
    .waitFor();
  await enter("left, to", "6");
  await page.getByText("must be at most 4").waitFor();
  await enter("left, to", "3");
  await limits()
    .getByText(/left: -4 to 3.*, at most 50 a second/)
    .waitFor();
  await limits().getByText("right: any value").waitFor();
  expect(await findings(page)).toEqual([]);
  expect(await smallTargets(page)).toEqual([]);
  await shot(page, "robot-limits");
  await page.keyboard.press("Escape");
});

test("a robot is narrowed in the dialog before it is connected", async () => {
  const { page } = studio;
  await observer.ask({ type: "use_world", kind: "Arena", path: "blocks" });
  await button(page, "Stop").waitFor({ state: "detached" });
  await page.getByRole("button", { name: /^World: / }).click();
  const dialog = page.getByRole("dialog");
  await dialog.getByLabel("Kind of world").selectOption("Zenoh");
  await dialog.getByLabel("robot", { exact: true }).fill(`epuck, at=${AT}, patience=20`);
  await field("left, from").waitFor();
  await enter("left, from", "-2");
  await enter("left, to", "2");
  await enter("right, to", "1");
  await button(page, "Use this world").click();
  await dialog.getByText(/has one end; a range has two/).waitFor();
  await enter("right, from", "-1");
  await shot(page, "robot-before");
  await button(page, "Use this world").click();
  await limits().getByText("left: -2 to 2").waitFor();
  await limits().getByText("right: -1 to 1").waitFor();
});
