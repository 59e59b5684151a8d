/** A box that is inserted into a wire makes room: what lies downstream moves right, as one step of undo. */
import type { Page } from "playwright-core";
import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { box, openEmpty, panel, select, settled, showEverything } from "./hands";
import { overlaps } from "./legibility";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio();
  observer = await studio.observe();
});

afterAll(() => studio.stop());

/** A stimulus, a field and a node in a row, a field below them, and a comment at the node. */
beforeEach(async () => {
  const { page } = studio;
  await page.emulateMedia({ reducedMotion: "reduce" });
  await openEmpty(page, observer);
  const add = (kind: string, name: string, at: [number, number], source?: string) => {
    const from = observer.document?.elements.find((e) => e.name === source)?.id;
    const wired = from === undefined ? {} : { source: { element: from } };
    return observer.ask({ type: "add_element", kind, name, at, values: {}, ...wired });
  };
  await add("GaussianStimulus", "s", [0, 0]);
  await observer.until(() => observer.document?.elements.length === 1);
  await add("Field", "u", [248, 0], "s");
  await observer.until(() => observer.document?.elements.length === 2);
  await add("RateNode", "node", [500, 0]);
  await add("Field", "v", [248, 260]);
  await observer.until(() => observer.document?.elements.length === 4);
  const [u, node] = [idOf("u"), idOf("node")];
  await observer.ask({ type: "connect", source: u, target: node });
  await observer.ask({ type: "comment", text: "number", at: [500, 120] });
  await box(page, "node").waitFor();
  await showEverything(page);
});

const idOf = (name: string): string => observer.document?.elements.find((e) => e.name === name)?.id ?? "";

type Layout = { boxes?: Record<string, { x: number }>; comments?: Record<string, { x: number }> };

const layout = (): Layout => observer.document?.layout as Layout;
const x = (name: string): number => layout().boxes?.[idOf(name)]?.x ?? Number.NaN;
const note = (): number => Object.values(layout().comments ?? {})[0]?.x ?? Number.NaN;
const xs = () => [x("s"), x("u"), x("node"), x("v"), note()];

/** Insert an entry of the palette into the wire between two boxes, at its middle. */
async function insert(page: Page, name: string, kind: string): Promise<void> {
  const wire = page.getByRole("img", { name, exact: true }).locator(".graph-wire");
  const at = await settled(page, () =>
    wire.evaluate((path: SVGPathElement) => {
      const point = path.getPointAtLength(path.getTotalLength() / 2);
      const { x, y } = new DOMPoint(point.x, point.y).matrixTransform(path.getScreenCTM() as DOMMatrix);
      return { x, y };
    }),
  );
  await page.mouse.click(at.x, at.y, { button: "right" });
  const chooser = page.getByRole("dialog", { name: "Insert an element" });
  await chooser.getByRole("option", { name: kind, exact: true }).click();
}

test("two boxes in one wire after each other, undone and redone", async () => {
  const { page } = studio;
  const before = xs();
  await insert(page, "s to u", "Field");
  await observer.until(() => observer.document?.elements.length === 5);
  await box(page, "field").waitFor();
  const first = xs();
  const by = 2 * 36 + 156 - 92;
  expect(first).toEqual([0, 248 + by, 500 + by, 248, 500 + by]);
  expect(await overlaps(page)).toEqual([]);
  await insert(page, "field to u", "Field");
  await observer.until(() => observer.document?.elements.length === 6);
  await box(page, "field2").waitFor();
  const second = xs();
  expect(second).toEqual([0, 248 + 192 + by, 500 + 192 + by, 248, 500 + 192 + by]);
  expect(await overlaps(page)).toEqual([]);
  await shot(page, "inserting-two");
  await page.keyboard.press("Control+z");
  await observer.until(() => observer.document?.elements.length === 5);
  expect(xs()).toEqual(first);
  await page.keyboard.press("Control+z");
  await observer.until(() => observer.document?.elements.length === 4);
  expect(xs()).toEqual(before);
  await page.keyboard.press("Control+Shift+z");
  await page.keyboard.press("Control+Shift+z");
  await observer.until(() => observer.document?.elements.length === 6);
  expect(xs()).toEqual(second);
});

test("a box that is dropped on a wire makes room too, and so does the Inspector's", async () => {
  const { page } = studio;
  await page.getByRole("img", { name: "s to u", exact: true }).locator(".graph-wire").click({ force: true });
  await panel(page, "Inspector").getByRole("button", { name: "Insert an element" }).click();
  const chooser = page.getByRole("dialog", { name: "Insert an element" });
  await chooser.getByRole("option", { name: "Gain", exact: true }).click();
  await observer.until(() => observer.document?.elements.length === 5);
  expect(xs(), "a coupling lies on the wire").toEqual([0, 248, 500, 248, 500]);
  const wire = page.getByRole("img", { name: "u to node", exact: true }).locator(".graph-wire");
  const [from, to] = [await box(page, "v").boundingBox(), await wire.boundingBox()];
  if (from === null || to === null) throw new Error("not visible");
  await page.mouse.move(from.x + from.width / 2, from.y + 8);
  await page.mouse.down();
  const aim = { x: to.x + to.width / 2, y: to.y + to.height / 2 };
  await page.mouse.move(aim.x, aim.y + 40, { steps: 4 });
  await page.mouse.move(aim.x, aim.y, { steps: 4 });
  await page.locator(".graph-wire[data-picked]").waitFor();
  await page.mouse.up();
  await observer.until(
    () => observer.document?.connections.some(({ source }) => source === idOf("v")) === true,
  );
  expect(x("v")).toBe(248 + 156 + 36);
  expect(x("node")).toBe(x("v") + 156 + 36);
  await settled(page, () => box(page, "node").boundingBox());
  expect(await overlaps(page)).toEqual([]);
  await select(page, "v");
  await shot(page, "inserting-dropped");
  await page.keyboard.press("Control+z");
  await observer.until(() => x("node") === 500);
  expect(x("v")).toBe(248);
});

/** The places of a box in all pictures until it has been still for ten of them. */
const watched = (page: Page, path: string, act: () => Promise<void>): Promise<number> =>
  box(page, path)
    .evaluate((node) => {
      const seen = new Set<number>();
      const held = window as unknown as { places: Set<number> };
      held.places = seen;
      const look = () => {
        seen.add(new DOMMatrix(getComputedStyle(node).transform).e);
        requestAnimationFrame(look);
      };
      look();
    })
    .then(async () => {
      await act();
      await settled(page, () => box(page, path).boundingBox());
      return await page.evaluate(() => (window as unknown as { places: Set<number> }).places.size);
    });

test("boxes glide to their places, and do not where motion is reduced", async () => {
  const { page } = studio;
  const add = (count: number) => async () => {
    await insert(page, "s to u", "Field");
    await observer.until(() => observer.document?.elements.length === count);
    await expect.poll(() => page.evaluate(() => document.querySelectorAll(".graph-box").length)).toBe(count);
  };
  expect(await watched(page, "node", add(5))).toBe(2);
  await page.keyboard.press("Control+z");
  await observer.until(() => observer.document?.elements.length === 4);
  await settled(page, () => box(page, "node").boundingBox());
  await page.emulateMedia({ reducedMotion: "no-preference" });
  expect(await watched(page, "node", add(5))).toBeGreaterThan(2);
  expect(x("node")).toBe(500 + 136);
});
