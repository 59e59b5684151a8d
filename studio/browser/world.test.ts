import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { frameOf, type PlanPoint, toPixels } from "../src/world/planFrame";
import { findings, smallTargets } from "./axe";
import { button, colours, panel } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

const PLAN = {
  arena: { x: [0, 3], y: [0, 2] },
  walls: [{ name: "wall", center: [2.2, 1.7], size: [0.1, 0.6] }],
  boxes: [{ name: "crate", center: [0.8, 1.5], size: [0.2, 0.3] }],
  start: [0.2, 1.0],
  goal: [2.7, 0.5],
};
const axisless = (kind: string, id: string, more: object) => ({ kind, id, axes: [], ...more });
const DRIVING = {
  deodar: 1,
  name: "driving",
  dt: 64,
  axes: {},
  elements: {
    "go left": axisless("Boost", "00000001", { amplitude: 1000 }),
    left: axisless("Motor", "00000002", { motor: "left" }),
    "go right": axisless("Boost", "00000003", { amplitude: 1000 }),
    right: axisless("Motor", "00000004", { motor: "right" }),
  },
  connections: [
    { source: "go left.output", target: "left.input" },
    { source: "go right.output", target: "right.input" },
  ],
};

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  const files = { "driving.json": JSON.stringify(DRIVING), "plan.json": JSON.stringify(PLAN) };
  studio = await startStudio({ files, file: "driving.json", words: ["--world", "arena:plan.json"] });
  observer = await studio.observe();
  await observer.runs();
  await observer.ask({ type: "watch_world", on: true });
});

beforeEach(async () => {
  await observer.ask({ type: "pause" });
  await observer.ask({ type: "reset" });
  await observer.until(() => !observer.running && observer.time === 0);
});

afterAll(() => studio.stop());

const world = () => panel(studio.page, "World");
const canvas = () => world().getByRole("img", { name: /^The world from above/ });
const told = () => world().getByRole("status");
const object = (name: string) =>
  [...(observer.world.now.scene?.boxes ?? []), ...(observer.world.now.scene?.marks ?? [])].find(
    (one) => one.name === name,
  );
const robot = () => observer.world.now.bodies[0]?.x ?? Number.NaN;

/** The pixel on the page of a position in the world. */
async function onPage(place: PlanPoint): Promise<PlanPoint> {
  const area = await canvas().boundingBox();
  if (area === null) throw new Error("The world is not visible.");
  const { x, y } = toPixels(frameOf([0, 0, 3, 2], area.width, area.height), place);
  return { x: area.x + x, y: area.y + y };
}

async function drag(from: PlanPoint, to: PlanPoint): Promise<void> {
  const { mouse } = studio.page;
  const [start, end] = [await onPage(from), await onPage(to)];
  await mouse.move(start.x, start.y);
  await mouse.down();
  await mouse.move(end.x, end.y, { steps: 8 });
  await mouse.up();
}

test("the world opens by itself, and a tooltip shows the name and position of an object", async () => {
  await canvas().waitFor();
  await expect.poll(() => colours(canvas())).toBeGreaterThan(4);
  const { x, y } = await onPage({ x: 0.8, y: 1.5 });
  await studio.page.mouse.move(x, y);
  await expect.poll(() => told().textContent()).toBe("crate: 0.80, 1.50 m");
});

test("a colour places a block before the robot, which its camera shows, and removes it again", async () => {
  const picture = world().getByRole("img", { name: "Picture of the camera, camera" });
  const red = () =>
    picture.evaluate((canvas: HTMLCanvasElement) => {
      const data = canvas.getContext("2d")?.getImageData(0, 0, canvas.width, canvas.height).data ?? [];
      return [...data].filter((value, i) => i % 4 === 0 && value > 180 && (data[i + 1] ?? 255) < 80).length;
    });
  await world().getByRole("button", { name: "Add its camera" }).click();
  const swatch = world().getByRole("button", { name: "red block" });
  await expect.poll(() => picture.evaluate((canvas: HTMLCanvasElement) => canvas.width)).toBe(40);
  await swatch.click();
  await observer.until(() => object("red block"));
  expect(object("red block")?.x).toBeCloseTo(0.2 + 0.037 + 2.2 * 1.65 * 0.037, 3);
  await observer.ask({ type: "step", n: 1 });
  await expect.poll(red).toBeGreaterThan(20);
  await shot(studio.page, "studio-world-camera");
  const { mouse } = studio.page;
  await world().getByRole("button", { name: "blue block" }).press("Enter");
  await observer.until(() => object("blue block"));
  const { x, y } = await onPage({ x: 0.5, y: 0.3 });
  await mouse.dblclick(x, y);
  await observer.until(() => object("box 1"));
  expect(observer.world.now.scene?.boxes.find(({ name }) => name === "box 1")?.color[2]).toBeGreaterThan(0.8);
  await canvas().press("Delete");
  await world().getByRole("button", { name: "blue block" }).press("Delete");
  await swatch.click();
  await observer.until(() => object("red block") === undefined && object("blue block") === undefined);
});

test("a crate that is dragged in front of the robot stops it until it is dragged away", async () => {
  // slow until the crate is there, however long the mouse takes on a busy machine
  await observer.ask({ type: "speed", factor: 0.1 });
  await button(studio.page, "Play").click();
  await observer.until(() => observer.running);
  await drag({ x: 0.8, y: 1.5 }, { x: 1.6, y: 1.05 });
  await observer.until(
    () =>
      Math.abs((object("crate")?.x ?? 0) - 1.6) < 0.05 && Math.abs((object("crate")?.y ?? 0) - 1.05) < 0.05,
  );
  expect(robot()).toBeLessThan(1.2);
  await observer.ask({ type: "speed", factor: 1 });
  await observer.until(() => robot() > 1.4);
  const { time } = observer;
  await observer.until(() => observer.time > time + 2000);
  expect(robot()).toBeLessThan((object("crate")?.x ?? 0) - 0.1 - 0.036);
  await shot(studio.page, "studio-world");
  await drag({ x: object("crate")?.x ?? 0, y: object("crate")?.y ?? 0 }, { x: 1.0, y: 0.3 });
  await observer.until(() => robot() > 1.8);
  expect(observer.world.now.path.length).toBeGreaterThan(20);
  await button(studio.page, "Pause").click();
  await observer.until(() => !observer.running);
});

test("a goal can be moved; a position that does not fit is refused with its reason", async () => {
  await drag({ x: 2.7, y: 0.5 }, { x: 2.5, y: 0.2 });
  await observer.until(() => Math.abs((object("goal")?.x ?? 0) - 2.5) < 0.02);
  const before = object("goal");
  const { mouse } = studio.page;
  const [from, to] = [
    await onPage({ x: before?.x ?? 0, y: before?.y ?? 0 }),
    await onPage({ x: 2.2, y: 1.7 }),
  ];
  await mouse.move(from.x, from.y);
  await mouse.down();
  await mouse.move(to.x, to.y);
  await expect.poll(() => told().textContent()).toMatch(/^goal: .* lies inside 'wall'/);
  await mouse.up();
  expect(object("goal")).toEqual(before);
});

test("a double click places a box, arrow keys move it, Delete removes it", async () => {
  const { x, y } = await onPage({ x: 0.4, y: 0.4 });
  await studio.page.mouse.dblclick(x, y);
  await observer.until(() => object("box 1"));
  await world().getByLabel("Object to move").selectOption("box 1");
  const before = object("box 1")?.x ?? Number.NaN;
  await canvas().press("ArrowRight");
  await observer.until(() => Math.abs((object("box 1")?.x ?? 0) - before - 0.03) < 1e-9);
  await canvas().press("Delete");
  await observer.until(() => object("box 1") === undefined);
});

test("a wide panel shows the picture beside the plan, one of 390 pixels above it", async () => {
  const { page } = studio;
  const parts = async () => ({
    picture: await world()
      .getByRole("img", { name: /^Picture of the camera/ })
      .boundingBox(),
    plan: await canvas().boundingBox(),
  });
  await page.setViewportSize({ width: 1600, height: 900 });
  await expect.poll(async () => (await canvas().boundingBox())?.width).toBeGreaterThan(700);
  const wide = await parts();
  expect(wide.picture?.x).toBeGreaterThan((wide.plan?.x ?? 0) + (wide.plan?.width ?? 0));
  expect(wide.picture?.width).toBeGreaterThan(400);
  await shot(page, "studio-world-wide");
  await page.setViewportSize({ width: 390, height: 800 });
  await expect.poll(async () => (await canvas().boundingBox())?.width).toBeLessThan(391);
  const narrow = await parts();
  expect(narrow.picture?.height).toBeGreaterThan(120);
  expect((narrow.picture?.y ?? 0) + (narrow.picture?.height ?? 0)).toBeLessThan(narrow.plan?.y ?? 0);
  expect(narrow.plan?.width).toBeGreaterThan(370);
  expect(narrow.plan?.height).toBeGreaterThan(250);
  const swatches = await world().getByRole("group", { name: "Blocks in front of the robot" }).boundingBox();
  expect(swatches?.height).toBeLessThan(35);
  expect(await findings(page)).toEqual([]);
  expect(await smallTargets(page)).toEqual([]);
  await shot(page, "studio-world-390");
});
