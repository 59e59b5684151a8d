import { writeFileSync } from "node:fs";
import { join } from "node:path";

import { afterAll, beforeAll, expect, test } from "vitest";

import { obstacles } from "./axe";
import { button, drop, openExample, png } from "./hands";
import type { Observer } from "./observer";
import { runScript } from "./server";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({ copies: ["examples/saliency.json"] });
  observer = await studio.observe();
  await openExample(studio.page, "Saliency");
  await observer.runs();
  await button(studio.page, "Play").click();
  await observer.until(() => observer.time > 0);
});

afterAll(() => studio.stop());

/** The largest value of a channel of the picture that the sensor reads. */
const channel = (n: number) =>
  Math.max(...observer.values("eye", "output").filter((_, index) => index % 3 === n));

test("a picture that is dropped on the page is what the sensor reads, and the run continues", async () => {
  const before = observer.time;
  await drop(studio.page, "red.png", "image/png", png(40, 40, [255, 0, 0]));
  await observer.until(() => observer.clock?.world === "Picture: red.png");
  await observer.until(() => channel(0) === 1 && channel(1) === 0 && channel(2) === 0);
  expect(observer.running).toBe(true);
  expect(observer.time).toBeGreaterThanOrEqual(before);
});

test("a picture below the folder can be chosen in the foot of the page, with a preview", async () => {
  const { page, folder } = studio;
  writeFileSync(join(folder, "blue.png"), png(40, 40, [0, 0, 255]));
  const before = observer.time;
  await button(page, "World: Picture: red.png; choose another one").click();
  const dialog = page.getByRole("dialog");
  expect(await dialog.getByLabel("Kind of world").inputValue()).toBe("Picture");
  await dialog.getByRole("button", { name: "blue.png" }).click();
  await dialog.getByRole("img", { name: "Preview of the world" }).waitFor();
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "world-picture");
  await dialog.getByRole("button", { name: "Use this world" }).click();
  await observer.until(() => observer.clock?.world === "Picture: blue.png");
  await observer.until(() => channel(0) === 0 && channel(2) === 1);
  expect(observer.running).toBe(true);
  expect(observer.time).toBeGreaterThanOrEqual(before);
});

test("a video and a record of another run are chosen in the foot as what the sensor reads", async () => {
  const { page, folder } = studio;
  await runScript("sensor_files", folder);
  const dialog = page.getByRole("dialog");
  const use = async (now: string, kind: string, file: string) => {
    await button(page, `World: ${now}; choose another one`).click();
    await dialog.getByLabel("Kind of world").selectOption(kind);
    await dialog.getByRole("button", { name: file }).click();
    await dialog.getByRole("button", { name: "Use this world" }).click();
    await dialog.waitFor({ state: "detached" });
    await observer.until(() => observer.clock?.world === `${kind}: ${file}`);
  };
  await use("Picture: blue.png", "Video", "green.avi");
  await observer.until(() => channel(0) < 0.1 && channel(1) > 0.9 && channel(2) < 0.1);
  await button(page, "Reset").click(); // a record ends
  await use("Video: green.avi", "Recording", "seen.zarr");
  await observer.until(() => channel(0) === 0 && channel(1) === 0 && channel(2) === 1);
  await shot(page, "world-recording");
  expect(observer.running).toBe(true);
});

test("a world that lacks a sensor of the model is shown and cannot be used", async () => {
  const { page } = studio;
  await button(page, "World: Recording: seen.zarr; choose another one").click();
  const dialog = page.getByRole("dialog");
  await dialog.getByLabel("Kind of world").selectOption("Arena");
  await dialog.getByLabel("layout").selectOption("z");
  await dialog.getByText("This world has no picture, which the model needs.").waitFor();
  expect(await dialog.getByRole("button", { name: "Use this world" }).isDisabled()).toBe(true);
  await shot(page, "world-arena");
  await page.setViewportSize({ width: 390, height: 800 });
  await shot(page, "world-arena-390");
  await page.setViewportSize({ width: 1280, height: 800 });
  await dialog.getByRole("button", { name: "Cancel" }).click();
  expect(observer.clock?.world).toBe("Recording: seen.zarr");
});

test("an arena is chosen with its settings while a robot drives, and the run continues", async () => {
  const { page } = studio;
  writeFileSync(join(studio.folder, "driving.json"), JSON.stringify(DRIVING));
  await observer.ask({ type: "open_file", path: "driving.json", discard: true });
  await observer.runs();
  await button(page, "Play").click();
  await observer.until(() => observer.time > 0);
  const before = observer.time;
  await button(page, "World: Arena: an example; choose another one").click();
  const dialog = page.getByRole("dialog");
  await dialog.getByLabel("layout").selectOption("z");
  await dialog.getByText("Settings").click();
  await dialog.getByLabel("unit", { exact: true }).fill("cm");
  await dialog.getByRole("img", { name: "Preview of the world" }).waitFor();
  await dialog.getByRole("button", { name: "Use this world" }).click();
  await observer.until(() => observer.clock?.world === "Arena: z");
  await observer.until(() => observer.world.now.scene?.unit === "cm");
  expect(observer.running).toBe(true);
  expect(observer.time).toBeGreaterThanOrEqual(before);
});

const DRIVING = {
  deodar: 1,
  name: "driving",
  dt: 64,
  axes: {},
  elements: {
    left: { kind: "Motor", id: "00000002", axes: [], motor: "left" },
    right: { kind: "Motor", id: "00000004", axes: [], motor: "right" },
  },
  connections: [],
};
