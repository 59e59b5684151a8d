import { afterAll, beforeAll, expect, test } from "vitest";

import { findings, smallTargets } from "./axe";
import { button, panel, settled } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

// A red cart on a rail over a floor, which a spring holds at 0.
const SCENE = `
<mujoco model="rail"><worldbody>
  <geom name="table" type="box" size="0.5 0.4 0.02" pos="0 0 -0.02" rgba="0.6 0.6 0.6 1"/>
  <body name="cart" pos="0 0.15 0.1" gravcomp="1">
    <joint name="rail" type="slide" axis="1 0 0" stiffness="40" damping="8"/>
    <geom type="box" size="0.06 0.06 0.06" rgba="0.9 0.05 0.05 1" mass="1" contype="0" conaffinity="0"/>
  </body>
</worldbody><sensor><jointpos name="at" joint="rail"/></sensor></mujoco>`;
const MODEL = {
  deodar: 1,
  name: "watching",
  dt: 10,
  axes: {},
  elements: { at: { kind: "Sensor", id: "00000001", axes: [], sensor: "at" } },
  connections: [],
};

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  const files = { "watching.json": JSON.stringify(MODEL), "rail.xml": SCENE };
  studio = await startStudio({ files, file: "watching.json", words: ["--world", "mujoco:rail.xml"] });
  observer = await studio.observe();
  await observer.runs();
  await observer.ask({ type: "watch_world", on: true, solid: true });
  await observer.ask({
    type: "place_object",
    name: "block",
    x: -0.25,
    y: -0.2,
    width: 0.12,
    height: 0.12,
    color: [0.05, 0.8, 0.1],
  });
});

afterAll(() => studio.stop());

const world = () => panel(studio.page, "World");
const view = () => world().getByRole("img", { name: /^The world in three dimensions/ });
const block = () => observer.world.now.scene?.boxes.find(({ name }) => name === "block");

/** The place of the cart on its rail. */
function cart(): number {
  const { solids, poses } = observer.world.now;
  return poses[12 * solids.findIndex(({ body }) => body === "cart")] ?? Number.NaN;
}

/** The middle of the pixels of a channel's colour on the page; null: there are none. */
async function middle(channel: 0 | 1): Promise<{ x: number; y: number; count: number } | null> {
  const area = await view().boundingBox();
  const found = await view()
    .locator("canvas")
    .evaluate((canvas: HTMLCanvasElement, channel) => {
      const copy = document.createElement("canvas");
      [copy.width, copy.height] = [canvas.width, canvas.height];
      const context = copy.getContext("2d");
      context?.drawImage(canvas, 0, 0);
      const data = context?.getImageData(0, 0, copy.width, copy.height).data ?? new Uint8ClampedArray();
      let [x, y, count] = [0, 0, 0];
      for (let k = 0; k < data.length; k += 4) {
        const others = [0, 1, 2].filter((c) => c !== channel).map((c) => data[k + c] ?? 0);
        if ((data[k + channel] ?? 0) > 60 + 2 * Math.max(...others)) {
          x += (k / 4) % copy.width;
          y += Math.floor(k / 4 / copy.width);
          count++;
        }
      }
      return { x: x / count / copy.width, y: y / count / copy.height, count };
    }, channel);
  return area === null || found.count === 0
    ? null
    : { x: area.x + found.x * area.width, y: area.y + found.y * area.height, count: found.count };
}

async function seen(channel: 0 | 1): Promise<{ x: number; y: number; count: number }> {
  await expect.poll(async () => (await middle(channel))?.count ?? 0).toBeGreaterThan(50);
  return (await middle(channel)) as { x: number; y: number; count: number };
}

/** How far the block is on the page from where it was. */
async function shifted(from: { x: number; y: number }): Promise<number> {
  const now = await middle(1);
  return now === null ? 0 : Math.hypot(now.x - from.x, now.y - from.y);
}

test("a world with solids is shown in three dimensions, at the same places as from above", async () => {
  await view().waitFor();
  const [red, green] = [await seen(0), await seen(1)];
  expect(green.x, "the block lies to the left of the cart").toBeLessThan(red.x);
  expect(green.y, "and before it").toBeGreaterThan(red.y);
  expect(await findings(studio.page)).toEqual([]);
  expect(await smallTargets(studio.page)).toEqual([]);
  await shot(studio.page, "studio-world-solid");
});

test("the view shows the whole floor in a panel of another shape, until the user turns it", async () => {
  const { page } = studio;
  const size = page.viewportSize() as { width: number; height: number };
  const apart = async () => {
    const [area, red, green] = [await view().boundingBox(), await seen(0), await seen(1)];
    return Math.hypot(red.x - green.x, red.y - green.y) / (area?.width ?? Number.NaN);
  };
  await seen(0);
  const before = await settled(page, apart);
  await page.setViewportSize({ width: 420, height: 900 });
  await expect.poll(async () => (await view().boundingBox())?.width).toBeLessThan(421);
  // a view that kept its height would show 0.34 of the width between them, and no whole floor
  await expect.poll(apart).toBeLessThan(0.3);
  await page.setViewportSize(size);
  await expect.poll(async () => Math.abs((await settled(page, apart)) - before)).toBeLessThan(0.01);
});

test("an object is dragged over the floor", async () => {
  const before = await seen(1);
  const { mouse } = studio.page;
  await mouse.move(before.x, before.y);
  await expect.poll(() => world().getByRole("status").textContent()).toMatch(/^block: -0\.25/);
  await mouse.down();
  await mouse.move(before.x + 60, before.y, { steps: 6 });
  await mouse.up();
  await observer.until(() => (block()?.x ?? -1) > -0.2);
  await expect.poll(async () => Math.abs(((await middle(1))?.x ?? 0) - before.x - 60)).toBeLessThan(8);
});

test("a body is pushed as long as the button is held, and goes back", async () => {
  await observer.ask({ type: "speed", factor: 1 });
  await button(studio.page, "Play").click();
  await observer.until(() => observer.running);
  const at = await seen(0);
  const { mouse } = studio.page;
  await mouse.move(at.x, at.y);
  await mouse.down();
  await mouse.move(at.x + 70, at.y, { steps: 5 });
  await observer.until(() => cart() > 0.05);
  await shot(studio.page, "studio-world-push");
  await mouse.up();
  await observer.until(() => Math.abs(cart()) < 0.01);
  expect(Math.abs((block()?.x ?? 0) + 0.25), "the view did not turn, the block stays").toBeGreaterThan(0.04);
  await button(studio.page, "Pause").click();
  await observer.until(() => !observer.running);
});

test("the pointer and the arrow keys turn the view, the wheel comes nearer", async () => {
  const area = await view().boundingBox();
  if (area === null) throw new Error("The world is not visible.");
  const { mouse } = studio.page;
  const place = () => [block()?.x, block()?.y];
  const [before, first] = [place(), await seen(1)];
  await mouse.move(area.x + area.width - 20, area.y + 20);
  await mouse.down();
  await mouse.move(area.x + area.width - 80, area.y + 20, { steps: 5 });
  await mouse.up();
  await expect.poll(() => shifted(first)).toBeGreaterThan(4);
  const turned = await seen(1);
  await mouse.wheel(0, -300);
  await expect.poll(async () => (await middle(1))?.count ?? 0).toBeGreaterThan(1.1 * turned.count);
  await world().getByLabel("Object to move").selectOption("");
  const nearer = await seen(1);
  await view().press("ArrowLeft");
  await expect.poll(() => shifted(nearer)).toBeGreaterThan(4);
  expect(place()).toEqual(before);
});

test("the same world is shown from above, and a double click in the view places a box", async () => {
  const area = await view().boundingBox();
  if (area === null) throw new Error("The world is not visible.");
  await studio.page.mouse.dblclick(area.x + area.width * 0.45, area.y + area.height * 0.62);
  await observer.until(() => observer.world.now.scene?.boxes.some(({ name }) => name === "box 1"));
  await world().getByText("From above").click();
  await world()
    .getByRole("img", { name: /^The world from above: .*box 1/ })
    .waitFor();
  await world().getByText("3-D").click();
  await view().waitFor();
  await seen(1);
});
