/**
 * Write every picture of the manual's chapter on the studio, light and dark, 1280 x 800, into the folder that
 * DEODAR_SHOTS names.
 */
import { readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import type { Page } from "playwright-core";
import { expect, onTestFinished, test } from "vitest";

import { frameOf, toPixels } from "../../src/world/planFrame";
import { choose, openExample, openTool } from "../hands";
import type { Observer } from "../observer";
import { runPython } from "../server";
import { shot, type Studio, type StudioOptions, startStudio } from "../studio";
import { writeTwoTargets } from "../twoTargets";

const COLOURS = ["light", "dark"] as const;
const PATIENCE = { timeout: 60_000 };
/** Where nothing answers the pointer. */
const REST = [420, 4] as const;

async function open(colours: "light" | "dark", options: StudioOptions): Promise<Studio> {
  const studio = await startStudio({ ...options, colours });
  onTestFinished(studio.stop);
  return studio;
}

/** An example that runs in a studio, with an observer. */
async function openRunning(
  colours: "light" | "dark",
  title: string,
): Promise<{ page: Page; observer: Observer }> {
  const studio = await open(colours, {});
  const observer = await studio.observe();
  await openExample(studio.page, title);
  await observer.runs();
  return { page: studio.page, observer };
}

/** Run until the clock shows this much document time, then pause. */
const run = (page: Page, milliseconds: number): Promise<void> =>
  runUntil(page, () =>
    expect.poll(async () => tick(page), { ...PATIENCE, interval: 100 }).toBeGreaterThan(milliseconds),
  );

async function runUntil(page: Page, done: () => Promise<unknown>): Promise<void> {
  await page.getByRole("button", { name: /^play/i }).click();
  await done();
  await page.getByRole("button", { name: /^pause/i }).click();
  await page.mouse.move(...REST);
  await page.waitForTimeout(500); // until the last frames are drawn
}

async function tick(page: Page): Promise<number> {
  const said = await page
    .getByText(/^step \d+$/)
    .first()
    .textContent();
  return Number(/\d+/.exec(said ?? "")?.[0] ?? 0);
}

async function select(page: Page, name: string): Promise<void> {
  await page.locator(".react-flow__node", { hasText: name }).first().click();
  await page.mouse.move(...REST);
  await page.waitForTimeout(500); // until the hover card is closed
}

for (const colours of COLOURS) {
  const name = (what: string) => (colours === "dark" ? `studio-${what}-dark` : `studio-${what}`);

  test(`gallery, ${colours}`, async () => {
    const { page } = await open(colours, {});
    await page.getByText("Selection", { exact: true }).first().waitFor(PATIENCE);
    await page.waitForLoadState("networkidle");
    await shot(page, name("gallery"));
  });

  test(`selection, ${colours}`, async () => {
    const { page } = await open(colours, { file: "selection.json", copies: ["examples/selection.json"] });
    await page.locator(".react-flow__node").first().waitFor(PATIENCE);
    await select(page, "u");
    await run(page, 700);
    await shot(page, name("selection"));
    for (const curve of ["input", "interaction"]) {
      const toggle = page.getByRole("button", { name: new RegExp(`^${curve}`, "i") }).first();
      await toggle.click();
      await expect.poll(() => toggle.getAttribute("aria-pressed")).toBe("true");
    }
    await page.mouse.move(...REST);
    await page.waitForTimeout(1000); // until the curves are drawn
    await shot(page, name("curves"));
  });

  test(`regime, ${colours}`, async () => {
    const { page } = await open(colours, { file: "selection.json", copies: ["examples/selection.json"] });
    await page.locator(".react-flow__node").first().waitFor(PATIENCE);
    await select(page, "u");
    await run(page, 700);
    await choose(page, "Open panels and plots", "Regime");
    await page.getByRole("button", { name: "Measure regime" }).click();
    await page.getByRole("button", { name: "Measure regime again" }).waitFor(PATIENCE);
    await page.mouse.move(...REST);
    await page.waitForTimeout(500);
    await shot(page, name("regime"));
  });

  test(`records, ${colours}`, async () => {
    const { page, folder } = await open(colours, { copies: ["examples/selection.json"] });
    const run = (out: string, amplitude: string) =>
      runPython(
        ["-m", "deodar", "run", "selection.json", "--no-progress", "--duration", "600", "--out", out]
          .concat(["--record", "u.activation", "u.output", "left.output", "right.output"])
          .concat(["--set", `right.amplitude=${amplitude}`]),
        folder,
      );
    await run("equal-inputs", "6");
    await run("stronger-right", "6.5");
    const choose = async (which: string) => {
      const dialog = page.getByRole("dialog");
      await dialog.getByRole("button", { name: which }).click();
      await dialog.waitFor({ state: "detached" });
    };
    await page.keyboard.press("Control+o");
    await choose("equal-inputs");
    await page.getByRole("button", { name: "Compare", exact: true }).click();
    await choose("stronger-right");
    await page
      .getByRole("button", { name: /first differs at/ })
      .first()
      .waitFor(PATIENCE);
    const slider = page.getByRole("slider", { name: "Moment" });
    await slider.press("End");
    await page.getByRole("status", { name: "Moment shown" }).getByText("600 ms").waitFor(PATIENCE);
    for (let n = 0; n < 18; n++) await slider.press("PageDown");
    await page.mouse.move(...REST);
    await page.waitForTimeout(500); // until the last frames are drawn
    await shot(page, name("records"));
  });

  test(`saliency, ${colours}`, async () => {
    const { page } = await open(colours, { file: "saliency.json", copies: ["examples/saliency.json"] });
    await page.locator(".react-flow__node").first().waitFor(PATIENCE);
    await run(page, 150);
    await shot(page, name("saliency"));
  });

  test(`groups and sliders, ${colours}`, async () => {
    const { page } = await startPinned(colours);
    await page.locator(".react-flow__node").first().waitFor(PATIENCE);
    await openTool(page, "Sliders");
    await run(page, 900);
    await shot(page, name("sliders"));
  });

  test(`world, ${colours}`, async () => {
    const words = ["--world", "arena:z, start=-0.45 0.55, goal=-0.65 0.65, place_noise=0.005, place_every=2"];
    const studio = await open(colours, {
      file: "spa.json",
      copies: ["examples/spa.json", ...spaArrays()],
      words,
    });
    const { page } = studio;
    const observer = await studio.observe();
    await observer.runs();
    await observer.ask({ type: "speed", factor: null });
    await run(page, 330);
    const canvas = page
      .getByRole("region", { name: "World", exact: true })
      .getByRole("img", { name: /^The world from above/ });
    const area = await canvas.boundingBox();
    const border = observer.world.now.scene?.border ?? [0, 0, 1, 1];
    if (area === null) throw new Error("The world is not visible.");
    const at = (x: number, y: number) =>
      toPixels(frameOf(border as [number, number, number, number], area.width, area.height), { x, y });
    const [from, to] = [at(-0.65, 0.65), at(-0.85, 0.2)];
    await page.mouse.move(area.x + from.x, area.y + from.y);
    await page.mouse.down();
    await page.mouse.move(area.x + to.x, area.y + to.y, { steps: 8 });
    await page.mouse.up();
    await run(page, 700);
    await shot(page, name("world"));
  });

  test(`pointing, ${colours}`, async () => {
    const { page, observer } = await openRunning(colours, "Pointing");
    const say = async (value: number) => {
      for (const name of ["say green", "say left"]) {
        const element = observer.element(name).id;
        await observer.ask({ type: "set", element, parameter: "amplitude", value });
      }
    };
    await say(3);
    const until = async (tick: number) => {
      await observer.ask({ type: "step", n: tick - (observer.clock?.tick ?? 0) });
      await observer.until(() => observer.clock?.tick === tick);
    };
    await until(40);
    await say(0);
    await until(130);
    await page.waitForTimeout(1000); // until the scene is drawn
    await shot(page, name("pointing"));
  });

  test(`eye, ${colours}`, async () => {
    const { page, observer } = await openRunning(colours, "Looking");
    // until the first peak has formed in the motor intention, and the gaze turns
    await observer.ask({ type: "speed", factor: 0.2 });
    await runUntil(page, () => observer.until(() => observer.max("motor intention", "output") > 0.9));
    await shot(page, name("eye"));
  });

  test(`blocks, ${colours}`, async () => {
    const parts = ["left", "right"].flatMap((side, k) => [
      [`go ${side}`, { kind: "Boost", id: `0000000${k + 1}`, axes: [], amplitude: 300 }],
      [`${side} wheel`, { kind: "Motor", id: `0000000${k + 3}`, axes: [], motor: side }],
    ]);
    const document = {
      deodar: 1,
      name: "driving",
      dt: 64,
      axes: {},
      elements: Object.fromEntries(parts) as object,
      connections: ["left", "right"].map((side) => ({
        source: `go ${side}.output`,
        target: `${side} wheel.input`,
      })),
    };
    const studio = await open(colours, {
      file: "driving.json",
      files: { "driving.json": JSON.stringify(document) },
      words: ["--world", "arena:blocks, start=0.2 0.4"],
    });
    const { page } = studio;
    const observer = await studio.observe();
    await observer.runs();
    const world = page.getByRole("region", { name: "World", exact: true });
    await world.getByRole("button", { name: "Add its camera" }).click();
    await world.getByRole("img", { name: /^Picture of the camera/ }).waitFor(PATIENCE);
    await world.getByRole("button", { name: "yellow block" }).click();
    await observer.until(() => observer.world.now.scene?.boxes.some((box) => box.name === "yellow block"));
    await run(page, 2);
    await shot(page, name("blocks"));
  });

  test(`lesson, ${colours}`, async () => {
    const { page, observer } = await openRunning(colours, "Colour search");
    await page.getByRole("button", { name: /^play/i }).click();
    const world = page.getByRole("region", { name: "World", exact: true });
    const isOn = (item: number) => observer.max(`item ${item}.node`, "activation") > 0;
    for (const [k, colour] of ["blue", "magenta", "red"].entries()) {
      await observer.until(() => isOn(k + 1));
      await world.getByRole("button", { name: `${colour} block` }).click();
      await observer.until(() => observer.max("satisfaction", "activation") > 0);
      await page.waitForTimeout(400);
      await world.getByRole("button", { name: `${colour} block` }).click();
      await observer.until(() => isOn(k + 2));
    }
    const produce = page.getByRole("switch", { name: "produce" });
    await produce.locator("xpath=..").click();
    await observer.until(() => isOn(1));
    await observer.until(() => isOn(2));
    await observer.until(() => isOn(3));
    const { time } = observer;
    await observer.until(() => observer.time > time + 500);
    await page.getByRole("button", { name: /^pause/i }).click();
    await page.mouse.move(...REST);
    await page.waitForTimeout(500); // until the last frames are drawn
    await shot(page, name("lesson"));
  });

  test(`experiment, ${colours}`, async () => {
    const { page, folder } = await open(colours, {});
    await writeTwoTargets(folder);
    await page.keyboard.press("Control+o");
    const dialog = page.getByRole("dialog");
    await dialog.getByRole("button", { name: "two-targets.json", exact: true }).click();
    await dialog.waitFor({ state: "detached" });
    await page.getByRole("button", { name: "Run the experiment" }).click();
    await page.getByText("100 of 100 trials, complete").waitFor({ timeout: 120_000 });
    await page.mouse.move(...REST);
    await page.waitForTimeout(500); // until the bars are drawn
    await shot(page, name("experiment"));
  });

  test(`problems, ${colours}`, async () => {
    const { page, folder } = await open(colours, { copies: ["examples/selection.json"] });
    const broken = JSON.stringify({
      deodar: 1,
      name: "broken",
      axes: { x: { name: "x", lower: 0, upper: 100, samples: 101 } },
      elements: { u: { kind: "Field", axes: ["x"], tau: -5 }, s: { kind: "GausianStimulus", axes: ["x"] } },
      connections: [{ source: "s.output", target: "u.input" }],
    });
    writeFileSync(join(folder, "broken.json"), broken);
    await page.getByRole("button", { name: /open a file/i }).click();
    await page.getByText("broken.json").first().click();
    const confirm = page.getByRole("dialog").getByRole("button", { name: /^open$/i });
    if (await confirm.count()) await confirm.click();
    await page.getByText("GausianStimulus").first().waitFor(PATIENCE);
    await page.waitForTimeout(400); // until the dialog is closed
    await shot(page, name("problems"));
  });
}

/** The arrays beside the example of planning. */
function spaArrays(): string[] {
  const examples = join(import.meta.dirname, "..", "..", "..", "examples");
  return readdirSync(examples)
    .filter((file) => /^spa\..*\.npz$/.test(file))
    .map((file) => `examples/${file}`);
}

/** The example with groups, one of them folded, with its document parameter and two parameters pinned. */
async function startPinned(colours: "light" | "dark"): Promise<Studio> {
  const { readFileSync } = await import("node:fs");
  const example = JSON.parse(
    readFileSync(join(import.meta.dirname, "..", "..", "..", "examples", "groups.json"), "utf-8"),
  );
  const first = example.elements["search.intention"].id as string;
  const layout = {
    folded: ["lift"],
    pins: [
      { element: "", parameter: "tempo" },
      { element: first, parameter: "resting_level" },
      { element: first, parameter: "noise" },
    ],
  };
  const studio = await open(colours, {});
  writeFileSync(join(studio.folder, "pinned.json"), JSON.stringify({ ...example, layout }));
  await studio.page.getByRole("button", { name: /open a file/i }).click();
  await studio.page.getByText("pinned.json").first().click();
  const confirm = studio.page.getByRole("dialog").getByRole("button", { name: /^open$/i });
  if (await confirm.count()) await confirm.click();
  return studio;
}
