import { afterAll, beforeAll, expect, test } from "vitest";

import { obstacles } from "./axe";
import { button, colours, openExample, panel } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio();
  observer = await studio.observe();
  await openExample(studio.page, "Looking");
  await observer.runs();
  await observer.ask({ type: "watch_world", on: true });
});

afterAll(() => studio.stop());

const world = () => panel(studio.page, "World");
const events = () => world().getByRole("img", { name: "Picture of the world, events" });

/** The middle of the pixels that had an event lately, by the numbers of their colours; null: too few. */
function middle(): { column: number; row: number } | null {
  const { pixels, picture } = observer.world.now;
  const columns = picture?.columns ?? 1;
  const lit: [number, number][] = [];
  for (let k = 0; k < pixels.length / 3; k++) {
    if ((pixels[3 * k] ?? 0) > 150 || (pixels[3 * k + 2] ?? 0) > 150) {
      lit.push([k % columns, Math.floor(k / columns)]);
    }
  }
  const mean = (at: 0 | 1) => lit.reduce((sum, one) => sum + one[at], 0) / lit.length;
  return lit.length < 20 ? null : { column: mean(0), row: mean(1) };
}

test("the panel of the world shows the events of an eye as they come, and nothing to place", async () => {
  await events().waitFor();
  expect(observer.world.now.picture).toEqual({ name: "events", columns: 128, rows: 128 });
  await observer.ask({ type: "speed", factor: 0.2 });
  await button(studio.page, "Play").click();
  await observer.until(() => middle() !== null);
  await expect.poll(() => colours(events())).toBeGreaterThan(10);
  await shot(studio.page, "studio-eye");
  expect(await world().getByRole("button", { name: "red block" }).count()).toBe(0);
  await button(studio.page, "Pause").click();
  await observer.until(() => !observer.running);
});

test("a target that is moved sends its events from another place", async () => {
  await observer.ask({ type: "reset" });
  const before = observer.world.now; // perhaps still of the run before
  await observer.ask({ type: "step", n: 60 });
  await observer.until(() => observer.world.now !== before && middle() !== null);
  await shot(studio.page, "studio-eye-before");
  const pose = observer.world.now.bodies[0];
  await observer.ask({
    type: "move_object",
    name: "target",
    x: (pose?.x ?? 0) + 200,
    y: (pose?.y ?? 0) - 200,
  });
  // 36 pixels to the right of the middle of the picture and below it, as in the plan; events fade at once
  let moved: { column: number; row: number } | null = null;
  const isThere = observer.until(() => {
    const now = middle();
    if (now !== null && Math.abs(now.column - 101) < 8) moved = now;
    return moved;
  });
  await observer.ask({ type: "step", n: 12 });
  await isThere;
  expect(moved).toMatchObject({ row: expect.closeTo(101, -1) });
  await shot(studio.page, "studio-eye-moved");
});

test("a narrow window shows the events above the plan, and everybody can use the panel", async () => {
  const { page } = studio;
  await page.setViewportSize({ width: 390, height: 800 });
  await events().waitFor();
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "studio-eye-390");
});
