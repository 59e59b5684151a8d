import type { Page } from "playwright-core";
import { afterEach, beforeEach, expect, test } from "vitest";

import { box, button, colours, drag, option, place, pull, slider } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

/** A user needs this long before each gesture. */
const THINKS_MS = 1200;
const MOST = { gestures: 14, mouse_ms: 180_000, keys: 40, keys_ms: 180_000 };

let studio: Studio;
let observer: Observer;

beforeEach(async () => {
  studio = await startStudio();
  observer = await studio.observe();
  await button(studio.page, "Empty document").waitFor();
});

afterEach(() => studio.stop());

/** Counts what a user does, and thinks before. */
class Counter {
  count = 0;
  readonly begun = performance.now();

  constructor(private page: Page) {}

  async does(gesture: () => Promise<unknown>): Promise<void> {
    this.count += 1;
    await this.page.waitForTimeout(THINKS_MS);
    await gesture();
  }

  get took(): number {
    return performance.now() - this.begun;
  }

  report(what: string): void {
    console.log(`${this.count} ${what}, ${(this.took / 1000).toFixed(0)} s`);
  }
}

/** A field with a kernel and two stimuli has a peak, and the page shows it. */
async function peak(): Promise<void> {
  const { page } = studio;
  await observer.until(() => observer.max("field", "activation") > 0);
  await expect
    .poll(() => colours(page.getByRole("img", { name: "activation of field, live" })))
    .toBeGreaterThan(2);
  const { elements = [], connections = [] } = observer.document ?? {};
  expect(elements.map(({ kind }) => kind).sort()).toEqual(["Field", "GaussianStimulus", "GaussianStimulus"]);
  expect((observer.value("field", "kernel") as unknown[]).length).toBe(1);
  expect(connections.length).toBe(2);
}

test("an empty document becomes a field with two stimuli and a peak, by the mouse", async () => {
  const { page } = studio;
  const user = new Counter(page);
  const choose = (name: string) => user.does(() => option(page, name).click());
  const connect = (path: string, to: { x: number; y: number }) =>
    user.does(async () => {
      await pull(page, path, to);
      await page.mouse.up();
    });

  await user.does(() => button(page, "Empty document").click());
  const [first, second, field] = [
    await place(page, 0.2, 0.25),
    await place(page, 0.2, 0.65),
    await place(page, 0.5, 0.4),
  ];
  await user.does(() => page.mouse.dblclick(first.x, first.y));
  await choose("Gaussian stimulus");
  await connect("gaussian_stimulus", field);
  await choose("Field");
  await user.does(() => page.mouse.dblclick(second.x, second.y));
  await choose("Gaussian stimulus");
  await user.does(() => drag(page, slider(page, "center"), 0.8));
  const target = await box(page, "field").boundingBox();
  await connect("gaussian_stimulus2", { x: (target?.x ?? 0) + 40, y: (target?.y ?? 0) + 40 });
  await user.does(() => button(page, "Play").click());
  await peak();
  user.report("gestures of the mouse");
  await shot(page, "build-mouse");
  expect(user.count).toBeLessThanOrEqual(MOST.gestures);
  expect(user.took).toBeLessThan(MOST.mouse_ms);
});

/** The smallest distance between two boxes, in units of the canvas; 0 where they overlap. */
const narrowest = (page: Page): Promise<number> =>
  page.locator(".react-flow__node-box").evaluateAll((nodes) => {
    const rects = nodes.map((node) => {
      const { e, f } = new DOMMatrix(getComputedStyle(node).transform);
      const { offsetWidth, offsetHeight } = node as HTMLElement;
      return { left: e, top: f, right: e + offsetWidth, bottom: f + offsetHeight };
    });
    const gaps = rects.flatMap((a, i) =>
      rects
        .slice(i + 1)
        .map((b) => Math.max(0, a.left - b.right, b.left - a.right, a.top - b.bottom, b.top - a.bottom)),
    );
    return Math.min(...gaps);
  });

test("an empty document becomes a field with two stimuli and a peak, by the keyboard alone", async () => {
  const { page } = studio;
  const user = new Counter(page);
  const press = async (...keys: string[]) => {
    for (const key of keys) await user.does(() => page.keyboard.press(key));
  };
  await press("Tab", "Tab", "Tab", "Enter");
  await press("/", "g", "a", "u", "Enter");
  await press("c", "f", "i", "Enter");
  await press("/", "g", "a", "u", "Enter");
  await press("c", "Enter");
  await press("Space");
  await peak();
  user.report("keys");
  await shot(page, "build-keys");
  expect(await narrowest(page), "room between boxes").toBeGreaterThanOrEqual(24);
  expect(user.count).toBeLessThanOrEqual(MOST.keys);
  expect(user.took).toBeLessThan(MOST.keys_ms);
});
