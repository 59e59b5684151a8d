import { existsSync, readdirSync } from "node:fs";
import { join } from "node:path";

import type { Locator, Page } from "playwright-core";
import { expect, onTestFinished, test } from "vitest";

import {
  box,
  button,
  choose,
  colours,
  drag,
  number,
  openTool,
  panel,
  select,
  settled,
  showView,
  slider,
  type,
} from "./hands";
import { shot, startStudio, type Studio, type StudioOptions } from "./studio";

/** The browser's messages for a server that does not run, or ended while it sent a picture. */
const GONE = [
  /WebSocket connection to .* failed/,
  /ERR_CONNECTION_REFUSED|ERR_CONNECTION_RESET|ERR_CONTENT_LENGTH_MISMATCH|ERR_EMPTY_RESPONSE/,
];

type Point = { x: number; y: number };

const NODE = { axes: [], sigmoid: { kind: "Logistic" }, kernel: [] };
const RUNAWAY = {
  deodar: 1,
  name: "runaway",
  elements: {
    calm: { kind: "Field", id: "00000001", ...NODE, tau: 10, resting_level: 0.5 },
    grow: { kind: "Field", id: "00000002", ...NODE, tau: 1, resting_level: 1, sigmoid: { kind: "Linear" } },
    gain: { kind: "Gain", id: "00000003", factor: 1e6 },
  },
  connections: [
    { source: "grow.output", target: "gain.input" },
    { source: "gain.output", target: "grow.input" },
  ],
};

async function start(options: StudioOptions = {}): Promise<Studio> {
  const studio = await startStudio({
    copies: ["examples/selection.json"],
    file: "selection.json",
    ...options,
  });
  onTestFinished(studio.stop);
  return studio;
}

test("the run continues without a page, and all open pages show the same state", async () => {
  const { page, another, observe } = await start();
  const observer = await observe();
  await observer.runs();
  const second = await another();
  await select(page, "u");
  await select(second, "u");
  await drag(page, slider(page, "resting_level"), 0.6);
  const dragged = await number(page, "resting_level").inputValue();
  expect(Math.abs(Number(dragged) - 2)).toBeLessThan(0.5);
  await observer.until(() => observer.value("u", "resting_level") === Number(dragged));
  await expect.poll(() => number(second, "resting_level").inputValue()).toBe(dragged);
  await type(second, "tau", "33");
  await expect.poll(() => number(page, "tau").inputValue()).toBe("33");
  await button(second, "Play").click();
  await button(page, "Pause").waitFor();
  await button(page, "Undo").click();
  await expect.poll(() => number(second, "tau").inputValue()).toBe("20");

  await page.close();
  await second.close();
  const { time } = observer;
  await observer.until(() => observer.time > time + 50);
  const third = await another();
  await button(third, "Pause").waitFor();
  await third.getByRole("img", { name: "Unsaved edits" }).waitFor();
  await select(third, "u");
  expect(await number(third, "resting_level").inputValue()).toBe(dragged);
});

test("a page reports a lost connection, reconnects by itself and shows the present state", async () => {
  const { page, restart, observe } = await start({ expected: GONE });
  await select(page, "u");
  await type(page, "tau", "33");
  await page.getByRole("img", { name: "Unsaved edits" }).waitFor();
  const back = restart();
  await page.getByText("Connection lost, trying again").waitFor();
  expect(await box(page, "u").count(), "what is there stays to look at").toBe(1);
  await back;
  await page.getByText("Connection lost, trying again").waitFor({ state: "detached" });
  const observer = await observe();
  await observer.runs();
  expect(observer.value("u", "tau"), "the file is opened afresh").toBe(20);
  await select(page, "u");
  await expect.poll(() => number(page, "tau").inputValue()).toBe("20");
  await page.getByRole("img", { name: "Unsaved edits" }).waitFor({ state: "detached" });
  await button(page, "Play").click();
  await observer.until(() => observer.max("u", "activation") > 3);
  await page
    .getByRole("region", { name: "Curves of u" })
    .getByText("Press play")
    .waitFor({ state: "detached" });
});

/** Where the curve in a box lies on the live layer, as shares of the height of its place in the box. */
const curve = (page: Page, path: string) =>
  box(page, path)
    .locator(".graph-live")
    .evaluate((slot) => {
      const layer = document.querySelector(".graph-live-layer") as HTMLCanvasElement;
      const [base, at] = [layer.getBoundingClientRect(), slot.getBoundingClientRect()];
      const scale = layer.width / base.width;
      const [left, width] = [(at.left - base.left) * scale, at.width * scale];
      const data = layer.getContext("2d")?.getImageData(left, 0, width, layer.height);
      const rows: number[] = [];
      (data?.data ?? []).forEach((value, i, all) => {
        if (i % 4 === 0 && (all[i + 3] ?? 0) > 128 && (all[i + 1] ?? 0) - value > 60)
          rows.push(base.top + Math.floor(i / 4 / (data?.width ?? 1)) / scale);
      });
      const near = rows.filter((row) => row > at.top - 20 && row < at.bottom + 20);
      const share = (row: number) => Math.round((33 * (row - at.top)) / at.height) / 33;
      return [share(Math.min(...near)), share(Math.max(...near))];
    });

test("without a connection controls are disabled and typed values restored", async () => {
  const { page, server, observe } = await start({ expected: GONE });
  const observer = await observe();
  await observer.runs();
  await button(page, "Play").click();
  await observer.until(() => observer.max("left", "output") > 4);
  await button(page, "Pause").click();
  await observer.until(() => !observer.running);
  await select(page, "u");
  await number(page, "tau").fill("77");
  await shot(page, "connected");
  observer.close();
  await server.stop("SIGKILL");
  await page.getByText("Connection lost, trying again").waitFor();
  for (const name of ["Play", "Reset", "Step", "File menu", "Run settings", "First frame"])
    await expect.poll(() => button(page, name).isDisabled(), { message: name }).toBe(true);
  expect(await number(page, "tau").isDisabled()).toBe(true);
  expect(await number(page, "tau").inputValue()).toBe("20");
  expect(await slider(page, "tau").count(), "a slider without a thumb").toBe(0);
  await page.getByRole("timer", { name: "Simulated time" }).getByText("not connected").waitFor();
  for (const name of ["Zoom in", "Help and keys"])
    expect(await button(page, name).isDisabled(), name).toBe(false);
  const there = await box(page, "u").boundingBox();
  await page.mouse.move((there?.x ?? 0) + 20, (there?.y ?? 0) + 12);
  await page.mouse.down();
  await page.mouse.move((there?.x ?? 0) + 80, (there?.y ?? 0) + 60, { steps: 4 });
  await page.mouse.up();
  expect(await page.locator(".react-flow__node.draggable").count(), "a box that can be dragged").toBe(0);
  expect(await page.locator(".react-flow__handle.connectable").count(), "a port to connect").toBe(0);
  await shot(page, "not-connected");
});

test("a part of the page that cannot be loaded says so, and is loaded when it is tried again", async () => {
  const { page, observe } = await start({
    expected: [...GONE, /ERR_FAILED|could not be loaded|preload CSS/],
  });
  const observer = await observe();
  await observer.runs();
  const parts = { Regime: () => openTool(page, "Regime"), Experiment: () => showView(page, "Experiment") };
  for (const [title, open] of Object.entries(parts)) {
    const code = new RegExp(`assets/${title}`);
    await page.route(code, (route) => route.abort());
    await open();
    const said = panel(page, title).getByRole("alert");
    await said.getByText("This part of the page could not be loaded").waitFor();
    await shot(page, `not-loaded-${title}`);
    await page.unroute(code);
    await said.getByRole("button", { name: "Try again" }).click();
    await said.waitFor({ state: "detached" });
  }
  const sheets = () =>
    page.evaluate(() => {
      const links = [
        ...document.querySelectorAll<HTMLLinkElement>('link[href*="Experiment"],link[href*="Regime"]'),
      ];
      return links.filter(({ rel, sheet }) => rel === "stylesheet" && sheet !== null).length;
    });
  await expect.poll(sheets, { message: "style sheets" }).toBe(2);
  await shot(page, "loaded-again");
});

test("a view that is opened first while the server is away does not empty the page", async () => {
  const { page, server } = await start({ expected: [...GONE, /could not be loaded|preload CSS/] });
  await box(page, "u").waitFor();
  await server.stop("SIGKILL");
  await page.getByText("Connection lost, trying again").waitFor();
  await showView(page, "Experiment");
  await panel(page, "Experiment").getByRole("alert").waitFor();
  await showView(page, "Build");
  await box(page, "u").waitFor();
});

test("without a connection plots keep their picture and take no change", async () => {
  const { page, server, observe } = await start({ expected: GONE });
  const observer = await observe();
  await observer.runs();
  const plot = page.getByRole("region", { name: "Curves of u" });
  await observer.ask({ type: "step", n: 50 });
  await plot.getByRole("status").waitFor({ state: "detached" }); // values have arrived
  await expect.poll(() => colours(plot.locator("canvas").first())).toBeGreaterThan(2);
  observer.close();
  await server.stop("SIGKILL");
  await page.getByText("Connection lost, trying again").waitFor();
  for (const name of ["Settings of this plot", "Edit what this plot shows", "input"])
    await expect
      .poll(() => plot.getByRole("button", { name, exact: true }).isDisabled(), { message: name })
      .toBe(true);
  const over = plot.locator(".plot-over");
  await over.hover();
  await page.mouse.down({ button: "right" });
  expect(await plot.locator(".plot-ghost[data-on]").count(), "an injection that is not made").toBe(0);
  await page.mouse.up({ button: "right" });
  await plot.getByRole("button", { name: "Menu of this plot" }).click();
  const entry = (name: string) => page.getByRole("menuitem", { name, exact: true });
  await entry("Export PNG").waitFor();
  expect(await entry("Export PNG").isDisabled(), "what is drawn can be exported").toBe(false);
  for (const name of ["Time course", "Save as a figure file"])
    expect(await entry(name).isDisabled(), name).toBe(true);
  expect(await colours(plot.locator("canvas").first())).toBeGreaterThan(2);
  await shot(page, "not-connected-plot");
});

/** What is done while the mouse button is down, by what is dragged, and what the new server must have. */
const GESTURES: Record<string, (studio: Studio) => Promise<void>> = {
  box: async ({ page }) => {
    await holdAndMove(page, box(page, "left"), { x: 20, y: 12 }, { x: 90, y: 70 });
    await page.locator(".react-flow__node.dragging").waitFor();
  },
  wire: async ({ page }) => {
    const output = box(page, "u").locator('.react-flow__handle[data-handleid="output"]');
    await holdAndMove(page, output, { x: 2, y: 2 }, { x: 60, y: 90 });
    await page.locator(".react-flow__connection").waitFor();
  },
  slider: async ({ page }) => {
    await select(page, "u");
    await settled(page, () => slider(page, "tau").boundingBox());
    await holdAndMove(page, slider(page, "tau"), { x: 5, y: 5 }, { x: 30, y: 0 });
  },
};

/** Press the mouse at a point of an element, and move it while it is down. */
async function holdAndMove(page: Page, from: Locator, at: Point, by: Point): Promise<void> {
  const there = await from.boundingBox();
  if (there === null) throw new Error("It is not visible.");
  const [x, y] = [there.x + at.x, there.y + at.y];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + by.x, y + by.y, { steps: 5 });
}

for (const [what, begin] of Object.entries(GESTURES)) {
  test(`a server that ends while a ${what} is dragged leaves nothing half done`, async () => {
    const studio = await start({ expected: GONE });
    const { page, server, restart, observe } = studio;
    const before = await observe();
    await before.runs();
    const document = JSON.stringify([before.document?.elements, before.document?.connections]);
    before.close();
    await begin(studio);
    await server.stop("SIGKILL");
    await page.getByText("Connection lost, trying again").waitFor();
    await page.mouse.move(600, 300, { steps: 3 });
    await page.mouse.up();
    await restart("SIGKILL");
    await page.getByText("Connection lost, trying again").waitFor({ state: "detached" });
    const after = await observe();
    await after.runs();
    expect(JSON.stringify([after.document?.elements, after.document?.connections])).toBe(document);
    expect(after.document?.undo).toBe(0);
    expect(await page.getByRole("dialog").count(), "a dialog of the gesture").toBe(0);
    expect(await page.locator("[data-wiring], .react-flow__connection").count(), "a wire in the air").toBe(0);
    await select(page, "u");
    await type(page, "tau", "31");
    await after.until(() => after.value("u", "tau") === 31);
  });
}

test("two pages that drag one box at once agree on its place", async () => {
  const { page, another, observe } = await start();
  const observer = await observe();
  await observer.runs();
  const second = await another();
  await box(second, "left").waitFor();
  await holdAndMove(page, box(page, "left"), { x: 20, y: 12 }, { x: 40, y: 80 });
  await holdAndMove(second, box(second, "left"), { x: 20, y: 12 }, { x: -60, y: 50 });
  await page.mouse.move(500, 420, { steps: 3 });
  await second.mouse.move(400, 390, { steps: 3 });
  await page.mouse.up();
  await second.mouse.up();
  const { id } = observer.element("left");
  const stored = () => (observer.document?.layout["boxes"] as Record<string, Point> | undefined)?.[id];
  await observer.until(() => observer.document?.undo === 2 && stored() !== undefined);
  const place = (one: Page) =>
    one
      .locator(`.react-flow__node[data-id="${id}"]`)
      .evaluate((node: HTMLElement) =>
        node.style.transform.match(/-?[\d.]+/g)?.map((n) => Math.round(Number(n))),
      );
  const at = stored() as Point;
  const agreed = [Math.round(at.x), Math.round(at.y)];
  await expect.poll(() => place(page)).toEqual(agreed);
  await expect.poll(() => place(second)).toEqual(agreed);
  for (const one of [page, second])
    expect((await one.getByRole("alert").allInnerTexts()).join(""), "alerts").toBe("");
});

test("live pictures follow their boxes when a bar moves them", async () => {
  const { page, server, observe } = await start({ expected: GONE });
  const observer = await observe();
  await observer.runs();
  await observer.ask({ type: "step", n: 200 });
  await observer.until(() => observer.max("left", "output") > 4);
  await expect.poll(async () => (await curve(page, "left"))[0]).toBeLessThan(0.3);
  const before = await curve(page, "left");
  const there = await box(page, "left").boundingBox();
  observer.close();
  await server.stop("SIGKILL");
  await page.getByText("Connection lost, trying again").waitFor();
  await expect.poll(async () => (await box(page, "left").boundingBox())?.y).not.toBe(there?.y);
  await page.waitForTimeout(1000);
  await shot(page, "live-layer");
  // the architecture is fitted again, so that a picture has other pixels
  const after = await curve(page, "left");
  after.forEach((share, i) => expect(share).toBeCloseTo(before[i] ?? NaN, 1));
});

test("unsaved edits are offered after a crash", async () => {
  const { page, state, restart, observe } = await start({ expected: GONE });
  await select(page, "u");
  await type(page, "tau", "44");
  await page.getByRole("img", { name: "Unsaved edits" }).waitFor();
  const kept = join(state, "unsaved");
  await expect
    .poll(() => existsSync(kept) && readdirSync(kept).some((name) => name.endsWith(".note")))
    .toBe(true);
  await restart("SIGKILL");
  await page.getByText("Connection lost, trying again").waitFor({ state: "detached" });
  const bar = page.getByRole("region", { name: "Unsaved edits", exact: true });
  await bar.getByText(/^Unsaved edits of selection, stored today at \d+:\d\d, were found\.$/).waitFor();
  await choose(page, "File menu", "Examples");
  const offer = page.getByRole("region", { name: "Unsaved edits of selection" });
  await offer.getByText("selection.json").waitFor();
  await shot(page, "recovery");
  await offer.getByRole("button", { name: "Open" }).click();
  await page.getByRole("img", { name: "Unsaved edits" }).waitFor();
  const observer = await observe();
  await observer.until(() => observer.document !== null && observer.value("u", "tau") === 44);
  expect(observer.document?.file).toBe("selection.json");
  await select(page, "u");
  expect(await number(page, "tau").inputValue()).toBe("44");
  await page.keyboard.press("Escape");
  await choose(page, "File menu", /^Save Ctrl/);
  await page.getByText("Saved as selection.json").waitFor();
  await expect.poll(() => readdirSync(kept)).toEqual([]);
});

test("the page of a file offers its unsaved edits after a crash, and opens or discards them", async () => {
  const { page, state, restart, observe } = await start({ expected: GONE });
  const kept = join(state, "unsaved");
  const notes = () => (existsSync(kept) ? readdirSync(kept).filter((name) => name.endsWith(".note")) : []);
  const bar = page.getByRole("region", { name: "Unsaved edits", exact: true });
  const crash = async (tau: string) => {
    await select(page, "u");
    await type(page, "tau", tau);
    await expect.poll(notes).toHaveLength(1);
    await restart("SIGKILL");
    await page.getByText("Connection lost, trying again").waitFor({ state: "detached" });
    await bar.waitFor();
    // the document of the new server takes the selection of the one before
    const canvas = page.locator(".react-flow__viewport");
    await settled(page, () => canvas.evaluate((one) => one.outerHTML.length));
  };
  await crash("44");
  await select(page, "u");
  expect(await number(page, "tau").inputValue(), "the version on disk").toBe("20");
  await shot(page, "recovery-bar");
  await bar.getByRole("button", { name: "Open them" }).click();
  await bar.waitFor({ state: "detached" });
  const observer = await observe();
  await observer.until(() => observer.document !== null && observer.value("u", "tau") === 44);
  await page.getByRole("img", { name: "Unsaved edits" }).waitFor();
  observer.close();

  await crash("55");
  await bar.getByRole("button", { name: "Discard" }).click();
  await bar.waitFor({ state: "detached" });
  expect(notes()).toEqual([]);
  await select(page, "u");
  expect(await number(page, "tau").inputValue()).toBe("20");
});

test("an element that fails stops the run, is named, and does not affect the rest", async () => {
  const { page, observe } = await start({
    files: { "runaway.json": JSON.stringify(RUNAWAY) },
    file: "runaway.json",
  });
  const observer = await observe();
  await observer.runs();
  await observer.ask({ type: "speed", factor: null });
  await button(page, "Play").click();
  const bar = page.getByRole("alert").filter({ hasText: "The run stopped" });
  await bar.waitFor();
  expect(await bar.innerText()).toMatch(/grow|gain/);
  await button(page, "Play").waitFor();
  const failed = observer.clock?.failure[0]?.element === observer.element("grow").id ? "grow" : "gain";
  await page
    .getByRole("button", { name: /^Problem: / })
    .or(page.getByRole("button", { name: /^gain, .*infinite/ }))
    .first()
    .waitFor();
  await shot(page, "failure");
  if (failed === "grow") await select(page, "grow");
  else await page.getByRole("button", { name: /^gain, / }).click();
  await panel(page, "Inspector").getByRole("alert").filter({ hasText: "infinite" }).waitFor();
  await observer.until(() => Number.isFinite(observer.max("calm", "activation")));

  await page.getByRole("button", { name: /^gain, / }).click();
  await type(page, "factor", "0");
  await observer.until(() => observer.value("gain", "factor") === 0);
  await bar.getByRole("button", { name: "Reset" }).click();
  await bar.waitFor({ state: "detached" });
  await button(page, "Play").click();
  await observer.until(() => observer.time > 100);
  expect(observer.clock?.failure).toEqual([]);
});
