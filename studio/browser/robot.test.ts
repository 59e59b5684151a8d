import { type ChildProcess, spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import { afterAll, beforeAll, expect, test } from "vitest";

import { findings, smallTargets } from "./axe";
import { button, panel } from "./hands";
import type { Observer } from "./observer";
import { python } from "./server";
import { startStudio, type Studio } from "./studio";

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
