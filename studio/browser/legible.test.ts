/** Names on the canvas can be read: with 70 boxes and with 500, on a wide and on a narrow page. */
import { readdirSync } from "node:fs";
import { join } from "node:path";

import type { Locator, Page } from "playwright-core";
import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { ident, many } from "./bench/documents";
import { median } from "./bench/figures";
import { mainThread } from "./bench/frames";
import { panned, zoomed } from "./bench/measures";
import { box, button, panel, showEverything, showView } from "./hands";
import { behind, misplacedNames, overlaps, SMALLEST } from "./legibility";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

const RATE = 20;
const ROUNDS = 3;
const WIDE = 1280;
const NARROW = 640;
const ELEMENTS = 500;
const GROUP = 25;
/** Between what is shown of planning: its boxes without couplings, and its four folded groups. */
const SPA_WIRES = 53;
const EXAMPLES = join(import.meta.dirname, "..", "..", "examples");
const SPA = readdirSync(EXAMPLES).filter((name) => /^spa\..*npz$|^spa\.json$/.test(name));

/** Five hundred elements in twenty groups, without a stored layout. */
function grouped(): object {
  const document = many(ELEMENTS) as {
    elements: Record<string, object>;
    connections: { source: string; target: string }[];
  };
  const path = (name: string) => `part${Math.floor(Number.parseInt(name.slice(1), 10) / GROUP)}.${name}`;
  return {
    ...document,
    groups: Array.from({ length: ELEMENTS / GROUP }, (_, i) => `part${i}`),
    elements: Object.fromEntries(
      Object.entries(document.elements).map(([name, element]) => [
        path(name),
        { ...element, id: ident(name) },
      ]),
    ),
    connections: document.connections.map(({ source, target }) => ({
      source: path(source),
      target: path(target),
    })),
    layout: {},
  };
}

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({
    copies: SPA.map((name) => `examples/${name}`),
    files: { "grouped.json": JSON.stringify(grouped()), "many.json": JSON.stringify(many(ELEMENTS)) },
    file: "spa.json",
  });
  observer = await studio.observe();
});

// The width decides how far the canvas is away.
beforeEach(() => studio.page.setViewportSize({ width: WIDE, height: 800 }));

afterAll(() => studio.stop());

/** The sizes of all visible names on the canvas, in px of the screen: the font's, and the lines' height. */
const names = (page: Page): Promise<{ text: string; size: number; height: number }[]> =>
  panel(page, "Architecture")
    .locator(".graph-box-name, .graph-frame-title, .graph-port, .graph-pill, .graph-count")
    .evaluateAll((all) =>
      all.flatMap((one) => {
        const range = document.createRange();
        range.selectNodeContents(one);
        const { width, height } = range.getBoundingClientRect();
        const viewport = one.closest(".react-flow__viewport") as HTMLElement;
        const zoom = new DOMMatrix(getComputedStyle(viewport).transform).a;
        const size = zoom * Number.parseFloat(getComputedStyle(one).fontSize);
        return width > 0 && one.textContent !== "" ? [{ text: one.textContent ?? "", size, height }] : [];
      }),
    );

/** Names once the canvas is still: the same number and sizes twice. */
async function settled(page: Page): ReturnType<typeof names> {
  let before = "";
  for (;;) {
    const now = await names(page);
    const known = JSON.stringify(now.map(({ text, size }) => [text, size]));
    if (known === before) return now;
    before = known;
    await page.waitForTimeout(150);
  }
}

/** The number of wires that are drawn. */
const wires = (page: Page): Promise<number> =>
  panel(page, "Architecture").locator(".react-flow__edge").count();

async function readable(page: Page, least: number): Promise<void> {
  const small = async () => {
    const all = await settled(page);
    return all.length < least
      ? null
      : all.filter(({ size, height }) => Math.min(size, height) < SMALLEST - 0.01);
  };
  await expect.poll(small, { message: "names that are too small; null: too few names" }).toEqual([]);
  expect(await misplacedNames(page), "names that leave their box or cover others").toEqual([]);
  expect(await overlaps(page), "boxes that overlap").toEqual([]);
  expect(await behind(page), "wires behind boxes").toEqual([]);
}

/** Open another file, and wait for what it shows, but not for its program. */
async function open(path: string, first: Locator): Promise<void> {
  await observer.ask({ type: "close", discard: true });
  await studio.page.getByRole("heading", { name: "Examples" }).waitFor();
  await observer.ask({ type: "open_file", path });
  await first.waitFor();
}

/** Change the width and reload: the page finds this width when it opens. */
async function reloaded(width: number): Promise<void> {
  await studio.page.setViewportSize({ width, height: 800 });
  await studio.page.reload();
}

const foldedGroup = (name: string) =>
  studio.page.getByRole("group", { name: new RegExp(`^Group ${name}, folded, `) });

test("the groups of planning are folded, names are readable, on a wide and a narrow page", async () => {
  const { page } = studio;
  await showView(page, "Build"); // it has a world
  await foldedGroup("north").waitFor();
  await readable(page, 20);
  await expect.poll(() => wires(page)).toBe(SPA_WIRES);
  await shot(page, "legible-spa-wide");
  await reloaded(NARROW);
  expect(observer.document?.layout.tiles, "no person changed the plots").toBeNull();
  await readable(page, 20);
  await shot(page, "legible-spa-narrow");
  await reloaded(WIDE);
  await readable(page, 20);
  await button(page, "Unfold north").click();
  await box(page, "north.motivation").waitFor();
  await observer.until(() => observer.document?.layout.folded);
  expect(observer.document?.layout.folded, "the others stay folded").toEqual(["south", "west", "east"]);
  await readable(page, 20);
  await shot(page, "legible-spa-open");
});

test("five hundred elements in groups are twenty folded groups", async () => {
  const { page } = studio;
  await open("grouped.json", foldedGroup("part0"));
  await readable(page, ELEMENTS / GROUP);
  await shot(page, "legible-grouped");
  await button(page, "Unfold part3").click();
  await box(page, "part3.u75").waitFor();
  await readable(page, ELEMENTS / GROUP);
  await shot(page, "legible-grouped-open");
});

test("five hundred elements without groups are dots until the canvas is zoomed in", async () => {
  const { page } = studio;
  await open("many.json", box(page, "u0"));
  await expect.poll(() => page.locator(".graph-box").count()).toBe(ELEMENTS);
  await readable(page, 0);
  expect(await names(page), "names of dots").toEqual([]);
  await expect.poll(() => wires(page)).toBe(observer.document?.connections.length);
  await shot(page, "legible-many");
  for (let i = 0; i < 4; i++) await button(page, "Zoom in").click();
  await readable(page, 20);
  await shot(page, "legible-many-near");
});

test("five hundred elements whose model runs are moved and zoomed at 20 frames a second", async () => {
  const { page } = studio;
  await showEverything(page);
  await observer.ask({ type: "play" });
  await observer.until(() => observer.time > 20);
  for (const [name, gesture] of Object.entries({ moving: panned, zooming: zoomed })) {
    const found: number[] = [];
    for (let i = 0; i < ROUNDS; i++) {
      const { rate, cpu } = await mainThread(page, () => gesture(page, 0.5));
      console.log(
        `${ELEMENTS} elements, ${name}: ${rate.toFixed(0)} frames/s, ${cpu.toFixed(1)} ms CPU each`,
      );
      found.push(cpu);
    }
    expect(median(found), `processor time of a frame while ${name}`).toBeLessThan(1000 / RATE);
  }
  await showEverything(page);
  await expect.poll(() => wires(page)).toBe(observer.document?.connections.length);
});
