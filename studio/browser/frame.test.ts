/** The frame of the page: tools, plots and other documents never move what a person works on. */
import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { TITLES } from "../src/frame/titles";
import { STANDING, TOOLS } from "../src/frame/tools";
import { panels, plot, selection } from "./bench/documents";
import { box, button, choose, panel, reopen, select, settled, showView } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

const TOOL_TITLES = [...TOOLS.values()].map(({ title }) => title);
const VIEWS = Object.values(TITLES);
const isExtra = (title: string) => TOOL_TITLES.indexOf(title) >= STANDING.length;
const KINDS = ["curve", "space_time", "course"] as const;
const ten = {
  ...selection,
  layout: { panels: panels([KINDS.map((kind) => plot("u", kind, "activation"))]) },
};

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({
    copies: ["examples/selection.json", "examples/node.json"],
    files: {
      "plots.json": JSON.stringify(ten),
      "authored.json": JSON.stringify({ ...selection, layout: { view: "run" } }),
    },
    file: "selection.json",
  });
  observer = await studio.observe();
  await observer.runs();
});

beforeEach(async () => {
  await studio.page.setViewportSize({ width: 1440, height: 900 });
  await reopen(studio.page, observer, "selection.json");
  await showView(studio.page, "Build");
  await box(studio.page, "u").waitFor();
});

afterAll(() => studio.stop());

const dock = () => studio.page.getByRole("complementary", { name: "Tools" });
const edge = () => studio.page.getByRole("separator", { name: "Width of the tools" });
const open = (title: string) => choose(studio.page, "Open panels and plots", title);

/** The places of the dock and of the canvas. */
const places = () =>
  settled(studio.page, async () => [
    await dock().boundingBox(),
    await studio.page.locator(".react-flow").boundingBox(),
    await studio.page.locator(".react-flow__viewport").getAttribute("style"),
  ]);

async function close(title: string): Promise<void> {
  await studio.page.getByRole("tab", { name: title, exact: true }).press("Delete");
  await panel(studio.page, title).waitFor({ state: "detached" });
  const tab = studio.page.getByRole("tab", { selected: true });
  expect(await tab.evaluate((drawn) => drawn === document.activeElement), "the focus").toBe(true);
}

test.each([
  [1440, 900, 320],
  [1024, 700, 300],
])("at %i x %i no tool moves the canvas, and the dock keeps its width", async (width, height, wide) => {
  const { page } = studio;
  await page.setViewportSize({ width, height });
  const before = await places();
  expect((await dock().boundingBox())?.width).toBe(wide);
  await expect.poll(() => edge().getAttribute("aria-valuenow")).toBe(String(wide));
  for (const title of [...TOOL_TITLES, ...VIEWS]) {
    await open(title);
    await panel(page, title).waitFor();
    expect((await dock().boundingBox())?.width, title).toBe(wide);
    if (VIEWS.includes(title)) await showView(page, "Build");
    expect(await places(), title).toEqual(before);
    if (isExtra(title)) await close(title);
  }
  let seed = 7;
  for (let i = 0; i < 50; i++) {
    seed = (seed * 16807) % 2147483647;
    const title = TOOL_TITLES[seed % TOOL_TITLES.length] ?? "";
    const tab = page.getByRole("tab", { name: title, exact: true });
    await ((await tab.count()) > 0 ? tab.click() : open(title));
    if (isExtra(title) && seed % 2 === 0) await close(title);
  }
  expect(await places()).toEqual(before);
  await shot(page, `frame-${width}`);
});

test("a person drags the dock to another width, within bounds, which the browser keeps", async () => {
  const { page } = studio;
  const width = async () => (await dock().boundingBox())?.width ?? 0;
  const drag = async (to: number) => {
    const from = await edge().boundingBox();
    if (from === null) throw new Error("The dock has no edge.");
    await page.mouse.move(from.x + 4, 300);
    await page.mouse.down();
    await page.mouse.move(to, 300, { steps: 4 });
    await page.mouse.up();
  };
  await drag(1440 - 400);
  await expect.poll(width).toBe(400);
  await drag(700);
  await expect.poll(width).toBe(480);
  await drag(1439);
  await expect.poll(width).toBe(280);
  await drag(700);
  await page.reload();
  await box(page, "u").waitFor();
  expect(await width()).toBe(480);
  await page.setViewportSize({ width: 1024, height: 700 });
  await expect.poll(width, { message: "40 % of the window" }).toBeCloseTo(0.4 * 1024, 0);
  await page.setViewportSize({ width: 1440, height: 900 });
  await edge().dblclick();
  await expect.poll(width).toBe(320);
});

/** The page without the names that differ from one opening to the next. */
const content = () =>
  settled(studio.page, () =>
    studio.page.evaluate(() =>
      (document.querySelector("#root > div:last-of-type")?.outerHTML ?? "")
        .replace(
          / (id|for|name|style|data-key|aria-(controls|labelledby|describedby|activedescendant))="[^"]*"/g,
          "",
        )
        // whether first values arrived is a matter of time
        .replace(/<div class="plot-message".*?<\/div>/g, "")
        .replace(/__m__-[\w-]*|url\([^)]*\)/g, "")
        .split(/(?=<)/),
    ),
  );

test("a document opens without any tool of the one before", async () => {
  const { page } = studio;
  const alone = async () => {
    await reopen(page, observer, "node.json");
    await page.locator(".graph-box").first().waitFor();
    await page.mouse.move(420, 4); // where nothing answers the pointer
    return content();
  };
  await page.reload();
  const first = await alone();
  await reopen(page, observer, "selection.json");
  for (const title of ["Experiment", "World", "Architecture", "Regime", "Costs"]) {
    await open(title);
    await panel(page, title).waitFor();
  }
  await choose(page, "Open panels and plots", "left");
  expect(await alone()).toEqual(first);
  await page.reload();
  await page.locator(".graph-live").first().waitFor(); // boxes are drawn before what is in them
  expect(await content(), "after a reload").toEqual(first);
});

/** The places of the plots. */
const plots = () =>
  settled(studio.page, () =>
    studio.page.locator("[data-tile]").evaluateAll((tiles) =>
      tiles.map((tile) => {
        const { x, y, width, height } = tile.getBoundingClientRect();
        return { x, y, width, height };
      }),
    ),
  );

test("nine plots are opened one by one in Run: all can be seen, and none is small", async () => {
  const { page } = studio;
  await showView(page, "Run");
  for (const name of ["left", "right"]) await open(name);
  expect(await plots()).toHaveLength(3);
  for (const kind of ["Space-time plot", "Time course"]) {
    for (const name of ["u", "left", "right"]) {
      const menus = page.getByRole("region", { name: new RegExp(` of ${name}$`) });
      await menus.last().getByRole("button", { name: "Menu of this plot" }).click();
      await page.getByRole("menuitem", { name: kind, exact: true }).click();
      await open(name);
    }
  }
  const wide = await plots();
  expect(wide).toHaveLength(9);
  for (const { x, y, width, height } of wide) {
    expect(width).toBeGreaterThanOrEqual(300);
    expect(height).toBeGreaterThanOrEqual(180);
    expect(x + width).toBeLessThanOrEqual(1440 - 320);
    expect(y + height).toBeLessThanOrEqual(900 - 56);
  }
  await shot(page, "frame-nine");
  await page.setViewportSize({ width: 1024, height: 700 });
  const narrow = await plots();
  expect(new Set(narrow.map(({ x }) => x)).size, "columns").toBe(2);
  for (const { width, height } of narrow) {
    expect(width).toBeGreaterThanOrEqual(300);
    expect(height).toBeGreaterThanOrEqual(180);
  }
  await page.locator("[data-tile]").last().scrollIntoViewIfNeeded();
  await observer.until(() => (observer.document?.layout["tiles"] as { run?: unknown[] })?.run?.length === 9);
});

test("a plot is moved by its head, enlarged by a double click, reduced by Esc and closed", async () => {
  const { page } = studio;
  await reopen(page, observer, "plots.json");
  await showView(page, "Run");
  const names = () =>
    page
      .locator("[data-tile] section.plot")
      .evaluateAll((all) => all.map((one) => one.getAttribute("aria-label")));
  const [curves, map, course] = ["Curves of u", "Space-time plot of u", "Time course of u"];
  await expect.poll(names).toEqual([curves, map, course]);
  const [, , last] = await plots();
  const head = (name: string | undefined) => page.getByRole("region", { name }).locator(".plot-path");
  await head(curves).hover();
  await page.mouse.down();
  await page.mouse.move((last?.x ?? 0) + 100, (last?.y ?? 0) + 60, { steps: 8 });
  await page.mouse.up();
  await expect.poll(names).toEqual([map, course, curves]);
  await observer.until(() =>
    JSON.stringify(observer.document?.layout.tiles ?? {}).includes('"run":[{"element"'),
  );

  await head(map).dblclick();
  const large = await page.getByRole("region", { name: map }).boundingBox();
  expect(large?.width).toBeGreaterThan(1100);
  await page.keyboard.press("Escape");
  await expect
    .poll(async () => (await plots()).map(({ width }) => width > 360 && width < 380))
    .toEqual([true, true, true]);
  await button(page, "Close this plot").first().click();
  await expect.poll(names).toEqual([course, curves]);
  await page.keyboard.press("Control+z");
  await expect.poll(names).toEqual([map, course, curves]);
  await page.keyboard.press("Control+z");
  await expect.poll(names, { message: "before it was dragged" }).toEqual([curves, map, course]);
  await page.keyboard.press("Control+Shift+z");
  await page.keyboard.press("Control+Shift+z");
  await expect.poll(names).toEqual([course, curves]);
  await reopen(page, observer, "plots.json");
});

test("the architecture is fitted at every size until a person moves it; then its middle stays", async () => {
  const { page } = studio;
  const view = () => page.locator(".react-flow__viewport").getAttribute("style");
  const sizes = async () => {
    const views: (string | null)[] = [];
    for (const [width, height] of [
      [1440, 900],
      [1024, 700],
      [1440, 900],
    ] as const) {
      await page.setViewportSize({ width, height });
      views.push(await settled(page, view));
    }
    return views;
  };
  await select(page, "u");
  await button(page, "Show everything").click();
  const [first, smaller, again] = await sizes();
  expect(smaller).not.toBe(first);
  expect(again).toBe(first);

  const middle = () =>
    page.evaluate(() => {
      const around = document.querySelector(".react-flow")?.getBoundingClientRect();
      const { a, e, f } = new DOMMatrix(
        getComputedStyle(document.querySelector(".react-flow__viewport") as Element).transform,
      );
      return [((around?.width ?? 0) / 2 - e) / a, ((around?.height ?? 0) / 2 - f) / a];
    });
  const pane = await page.locator(".react-flow").boundingBox();
  await page.mouse.move((pane?.x ?? 0) + 300, (pane?.y ?? 0) + (pane?.height ?? 0) - 20);
  await page.mouse.wheel(0, -200);
  await settled(page, view);
  await page.keyboard.press("Escape");
  const before = await middle();
  await page.setViewportSize({ width: 1360, height: 860 });
  await settled(page, view);
  const after = await middle();
  expect(after[0]).toBeCloseTo(before[0] ?? 0, 0);
  expect(after[1]).toBeCloseTo(before[1] ?? 0, 0);

  await page.setViewportSize({ width: 860, height: 600 });
  await settled(page, view);
  const inside = await box(page, "u").boundingBox();
  const around = await page.locator(".react-flow").boundingBox();
  if (inside === null || around === null) throw new Error("The box is not visible.");
  expect(inside.x).toBeGreaterThanOrEqual(around.x);
  expect(inside.x + inside.width).toBeLessThanOrEqual(around.x + around.width);
  expect(inside.y).toBeGreaterThanOrEqual(around.y);
  expect(inside.y + inside.height).toBeLessThanOrEqual(around.y + around.height);
});

test("the key F shows the whole architecture, which is fitted from then on", async () => {
  const { page } = studio;
  const view = () => settled(page, () => page.locator(".react-flow__viewport").getAttribute("style"));
  await button(page, "Show everything").click();
  const whole = await view();
  const pane = await page.locator(".react-flow").boundingBox();
  await page.mouse.move((pane?.x ?? 0) + 300, (pane?.y ?? 0) + (pane?.height ?? 0) - 20);
  await page.mouse.wheel(0, -200);
  expect(await view()).not.toBe(whole);
  await page.keyboard.press("f");
  await expect.poll(view).toBe(whole);
  await page.setViewportSize({ width: 1024, height: 700 });
  expect(await view()).not.toBe(whole);
  await page.setViewportSize({ width: 1440, height: 900 });
  await expect.poll(view).toBe(whole);
});

test("the author states the view, and the frame of the author is restored", async () => {
  const { page } = studio;
  const view = () => page.getByRole("radio", { checked: true }).getAttribute("value");
  await showView(page, "Run");
  await open("Open the document in this view");
  await observer.until(() => observer.document?.layout["view"] === "run");
  await showView(page, "Build");
  await open("left");
  await expect.poll(async () => (await plots()).length).toBe(2);
  await open("Costs");
  await open("Restore views, tools and plots");
  await expect.poll(view).toBe("run");
  await expect.poll(async () => (await plots()).length).toBe(1);
  await panel(page, "Sliders").waitFor();
  await showView(page, "Build");
  await expect.poll(async () => (await plots()).length).toBe(1);
  expect(await page.getByRole("tab", { name: "Costs" }).count()).toBe(0);
});

test("a view is what its author stated, then what the person chose for this file", async () => {
  const { page } = studio;
  const view = () => page.getByRole("radio", { checked: true }).getAttribute("value");
  await expect.poll(view).toBe("build");
  await reopen(page, observer, "authored.json");
  await expect.poll(view).toBe("run");
  await showView(page, "Experiment");
  await page.reload();
  await expect.poll(view).toBe("experiment");
});
