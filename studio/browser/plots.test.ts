import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import type { Locator, Page } from "playwright-core";
import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { ident, many, panels, plot as plotOf, selection, ten } from "./bench/documents";
import { beside, button, choose, colours, downloaded, drawn, reopen, settled, showView } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

/** Twenty small plots, in five columns. */
const KINDS = [
  ["map", "heat"],
  ["u", "curve"],
  ["u", "space_time"],
  ["n", "course"],
  ["map", "curve"],
  ["u", "phase"],
  ["r", "kernel"],
] as const;
const twenty = {
  ...ten,
  layout: {
    panels: panels(
      [0, 5, 10, 15].map((first) =>
        [0, 1, 2, 3, 4].map((column) => {
          const [element, kind] = KINDS[(first + column) % KINDS.length] ?? KINDS[0];
          return plotOf(element, kind, "activation");
        }),
      ),
    ),
  },
};

/** Three plots side by side: over position, over both, and over time. */
const linked = {
  ...selection,
  layout: {
    panels: panels([
      [plotOf("u", "curve", "activation"), plotOf("u", "space_time", "activation")],
      [plotOf("u", "course", "activation")],
    ]),
  },
};

/** A field and a stimulus that is on during two time windows. */
const edited = {
  ...selection,
  elements: {
    ...selection.elements,
    left: { ...selection.elements.left, id: ident("left"), windows: [{ kind: "Window", start: 20 }] },
  },
  layout: { panels: panels([[plotOf("u", "curve", "activation")], [plotOf("left", "course", "output")]]) },
};

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({
    copies: ["examples/selection.json", "examples/node.json", "examples/saliency.json"],
    files: {
      "linked.json": JSON.stringify(linked),
      "edited.json": JSON.stringify(edited),
      "twenty.json": JSON.stringify(twenty),
      "many.json": JSON.stringify({
        ...many(20),
        layout: { panels: panels([[plotOf("u0", "multiples", "activation")]]) },
      }),
    },
    file: "selection.json",
  });
  observer = await studio.observe();
});

beforeEach(() => reopen(studio.page, observer, "selection.json"));

afterAll(() => studio.stop());

const plot = (name: string): Locator => studio.page.getByRole("region", { name, exact: true });
const chart = (name: string, label: string): Locator =>
  plot(name).getByRole("img", { name: label, exact: true });
const arranged = () => JSON.stringify(observer.document?.layout["tiles"] ?? {});

type Written = { text: string; size: number; left: number; right: number; top: number; bottom: number };
type Listening = typeof globalThis & { written: Map<HTMLCanvasElement, Written[]> };

/** In the page: note where charts write which texts, in pixels of the page. */
function listenToTexts(): void {
  const written = new Map<HTMLCanvasElement, Written[]>();
  (globalThis as Listening).written = written;
  const { clearRect, fillText } = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.clearRect = function (...box) {
    written.set(this.canvas, []);
    clearRect.apply(this, box);
  };
  CanvasRenderingContext2D.prototype.fillText = function (text, x, y, most) {
    const size = parseFloat(/([\d.]+)px/.exec(this.font)?.[1] ?? "0");
    const measured = this.measureText(text);
    const at = this.getTransform();
    const corners = [
      [x - measured.actualBoundingBoxLeft, y - measured.actualBoundingBoxAscent],
      [x + measured.actualBoundingBoxRight, y + measured.actualBoundingBoxDescent],
    ].map(([a, b]) => at.transformPoint({ x: a ?? 0, y: b ?? 0 }));
    const [xs, ys] = [corners.map((corner) => corner.x), corners.map((corner) => corner.y)];
    const box = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    const [left = 0, right = 0, top = 0, bottom = 0] = box.map((value) => value / devicePixelRatio);
    written.get(this.canvas)?.push({ text, size: size / devicePixelRatio, left, right, top, bottom });
    fillText.call(this, text, x, y, most ?? Number.MAX_VALUE);
  };
}

/** In the page: the texts of every chart. */
function readTexts(): { name: string; texts: Written[]; width: number; height: number }[] {
  return [...document.querySelectorAll<HTMLCanvasElement>(".plot canvas[role=img]")].map((canvas) => ({
    name: canvas.getAttribute("aria-label") ?? "",
    texts: (globalThis as Listening).written.get(canvas) ?? [],
    width: canvas.clientWidth,
    height: canvas.clientHeight,
  }));
}

/** No text of the charts is tiny, outside its chart or on another text. */
async function expectReadable(page: Page, count: number): Promise<void> {
  const charts = await page.evaluate(readTexts);
  expect(charts).toHaveLength(count);
  for (const { name, texts, width, height } of charts) {
    expect(texts.length, `${name} has numbers on both axes`).toBeGreaterThanOrEqual(4);
    for (const [i, text] of texts.entries()) {
      expect(text.size, `${name}: ${text.text}`).toBeGreaterThanOrEqual(10);
      const across = text.left >= -1 && text.right <= width + 1;
      const inside = across && text.top >= -1 && text.bottom <= height + 1;
      expect(inside, `${name}: ${JSON.stringify(text)} in ${width} x ${height}`).toBe(true);
      for (const other of texts.slice(i + 1)) {
        const beside = text.right < other.left || other.right < text.left;
        const apart = beside || text.bottom < other.top || other.bottom < text.top;
        expect(apart, `${name}: ${text.text} and ${other.text}`).toBe(true);
      }
    }
  }
}

/** The number of different colours of a scene that is drawn by WebGL. */
async function shades(scene: Locator): Promise<number> {
  await scene.waitFor();
  return scene.evaluate((element) => {
    const copy = document.createElement("canvas");
    copy.width = (element as HTMLCanvasElement).width;
    copy.height = (element as HTMLCanvasElement).height;
    const ctx = copy.getContext("2d") as CanvasRenderingContext2D;
    ctx.drawImage(element as HTMLCanvasElement, 0, 0);
    return new Set(new Uint32Array(ctx.getImageData(0, 0, copy.width, copy.height).data.buffer)).size;
  });
}

/** Write a file beside the screenshots, if they are kept. */
function keep(name: string, text: string): void {
  const folder = process.env["DEODAR_SHOTS"];
  if (folder) writeFileSync(join(folder, name), text);
}

async function step(n: number): Promise<void> {
  await observer.ask({ type: "step", n });
  await observer.until(() => observer.clock?.tick === n);
}

test("the first field is plotted from the start, with threshold and resting level", async () => {
  const { page } = studio;
  const curves = plot("Curves of u");
  const drawing = chart("Curves of u", "activation, output of u over x");
  const before = await drawn(drawing);
  await step(300);
  await curves.getByText("Press play to see values").waitFor({ state: "detached" });
  await expect.poll(() => drawn(drawing)).not.toBe(before);
  expect(await colours(drawing)).toBeGreaterThan(5);
  expect(await curves.getByRole("button", { name: "levels" }).getAttribute("aria-pressed")).toBe("true");
  const width = await drawing.evaluate((canvas) => (canvas as HTMLCanvasElement).width);
  await page.setViewportSize({ width: 1000, height: 700 });
  await expect
    .poll(() => drawing.evaluate((canvas) => (canvas as HTMLCanvasElement).width))
    .toBeLessThan(width);
  await page.setViewportSize({ width: 1280, height: 800 });
});

test("input, interaction and resting level are separate curves, chosen one by one", async () => {
  await step(300);
  const curves = plot("Curves of u");
  for (const name of ["input", "interaction"]) {
    await curves.getByRole("button", { name, exact: true }).click();
    await expect
      .poll(() => curves.getByRole("button", { name, exact: true }).getAttribute("aria-pressed"))
      .toBe("true");
  }
  const all = chart("Curves of u", "activation, output, input, interaction of u over x");
  await expect.poll(() => colours(all)).toBeGreaterThan(10);
  await shot(studio.page, "plot-curves");
  for (const name of ["output", "levels"]) await curves.getByRole("button", { name, exact: true }).click();
  await chart("Curves of u", "activation, input, interaction of u over x").waitFor();
  await observer.until(() => arranged().includes('"shown":["activation","input","interaction"]'));
});

test("a plot shows the largest value of a field over time", async () => {
  const { page } = studio;
  await choose(page, "Menu of this plot", "Time course");
  const drawing = chart("Time course of u", "max of activation over time");
  await drawing.waitFor();
  const before = await drawn(drawing);
  await button(page, "Play").click();
  await observer.until(() => observer.max("u", "activation") > 3);
  await expect.poll(() => drawn(drawing)).not.toBe(before);
  expect(await colours(drawing)).toBeGreaterThan(5);
  await button(page, "Pause").click();
});

test("a plot shows a field over time, also of a moment of the past", async () => {
  const { page } = studio;
  await choose(page, "Menu of this plot", "Space-time plot");
  const map = plot("Space-time plot of u");
  const canvas = map.locator("canvas.plot-heat");
  await expect.poll(() => colours(canvas)).toBeGreaterThan(1);
  await step(300);
  await expect.poll(() => colours(canvas)).toBeGreaterThan(10);
  const drawing = map.getByRole("img", { name: "activation of u as colours over time and x" });
  expect(await colours(drawing), "the colour bar").toBeGreaterThan(50);
  // 101 samples upwards, time to the right
  const size = () => canvas.evaluate((element) => (element as HTMLCanvasElement).height);
  expect(await size()).toBe(101);
  // Of 2000 ms that fit, 300 have values; the rest is empty.
  const share = () =>
    canvas.evaluate((element) => {
      const { width, height } = element as HTMLCanvasElement;
      const pixels = (element as HTMLCanvasElement).getContext("2d")?.getImageData(0, 0, width, height).data;
      return Array.from(pixels ?? []).filter((value, i) => i % 4 === 3 && value > 0).length / width / height;
    });
  await expect.poll(share).toBeGreaterThan(0.148);
  expect(await share()).toBeLessThan(0.153);
  const before = await drawn(drawing);
  await button(page, "First frame").click();
  await expect.poll(() => drawn(drawing)).not.toBe(before);
  expect(await share(), "what came later stays").toBeGreaterThan(0.148);
  await button(page, "Live").click();
  await expect.poll(() => drawn(drawing)).toBe(before);

  await map.locator(".plot-over").hover({ position: { x: 20, y: 40 } });
  await map.getByText(/^t \d.*x \d.*/).waitFor();
  await beside(page, "Settings of this plot", (settings) => settings.getByText("time down").click());
  const across = () => canvas.evaluate((element) => (element as HTMLCanvasElement).width);
  await expect.poll(across).toBe(101);
  await observer.until(() => arranged().includes('"down":true'));
  await shot(page, "plot-space-time");
});

test("the cursor of one plot shows its position and its time in all others, with their values", async () => {
  const { page } = studio;
  await page.setViewportSize({ width: 1600, height: 900 });
  await reopen(page, observer, "linked.json");
  await showView(page, "Run");
  await step(300);
  const readout = (name: string) => plot(name).locator(".plot-readout");
  const reads = (name: string, words: string) =>
    expect
      .poll(async () => (await readout(name).textContent())?.replace(/\s+/g, " "))
      .toMatch(
        new RegExp(`^${words.replaceAll(".", "\\.").replaceAll("#", "\\d+").replaceAll("-", "\u2212")}$`),
      );
  const [curves, map, course] = ["Curves of u", "Space-time plot of u", "Time course of u"] as const;
  await plot(course).getByText("Press play").waitFor({ state: "detached" });
  const over = plot(map).locator(".plot-over");
  const room = await settled(page, () => over.boundingBox());
  if (room === null) throw new Error("The plot is not visible.");
  await over.hover({ position: { x: room.width * 0.1, y: room.height * 0.3 } });
  await reads(curves, "x #.# activation #.# output 1.000");
  await reads(course, "t #.# s #.#");
  await shot(page, "plot-linked");

  await plot(curves).locator(".plot-over").hover();
  await reads(map, "x #.# -#.#");
  expect(await readout(course).textContent()).toBe("");
  await page.getByRole("toolbar", { name: "Run" }).hover();
  await expect.poll(() => readout(map).textContent()).toBe("");
  await page.setViewportSize({ width: 1280, height: 800 });
});

test("twenty plots of 300 x 180 pixels are readable: no text is tiny, cut or covered", async () => {
  const { page } = studio;
  await page.evaluate(listenToTexts);
  // what surrounds the plots: the head, the foot, the dock and the gaps
  await page.setViewportSize({ width: 3 * 301 + 300, height: 7 * 181 + 48 + 57 });
  await reopen(page, observer, "twenty.json");
  await showView(page, "Run");
  await step(40);
  await expect.poll(() => page.getByRole("region").getByText("Press play").count()).toBe(0);
  const boxes = await settled(page, () =>
    page.locator(".plot").evaluateAll((plots) => plots.map((one) => one.getBoundingClientRect().toJSON())),
  );
  expect(boxes).toHaveLength(20);
  for (const { width, height } of boxes) {
    expect(Math.abs(width - 300)).toBeLessThan(4);
    expect(Math.abs(height - 180)).toBeLessThan(4);
  }
  await shot(page, "plot-twenty");
  await expectReadable(page, 20);
  const titles = await page.locator(".plot-path").evaluateAll((all) =>
    all.map((one) => ({
      size: parseFloat(getComputedStyle(one).fontSize),
      cut: one.scrollWidth > one.clientWidth,
    })),
  );
  expect(titles.every(({ size, cut }) => size >= 11 && !cut)).toBe(true);
  await page.setViewportSize({ width: 1280, height: 800 });
});

test("small multiples show the fields over the same axes side by side, on the same scale", async () => {
  const { page } = studio;
  await page.evaluate(listenToTexts);
  await page.setViewportSize({ width: 5 * 160 + 18 + 301, height: 4 * 102 + 150 });
  await reopen(page, observer, "many.json");
  await showView(page, "Run");
  await step(40);
  const multiples = plot("Small multiples of u0");
  await expect.poll(() => multiples.locator(".plot-cell canvas[role=img]").count()).toBe(20);
  await multiples.getByText("Press play").waitFor({ state: "detached" });
  await expect.poll(() => colours(multiples.locator("canvas[role=img]").last())).toBeGreaterThan(5);
  await expectReadable(page, 20);
  const cells = await multiples
    .locator(".plot-cell")
    .evaluateAll((all) => all.map((one) => [one.clientWidth, one.clientHeight] as const));
  for (const [width, height] of cells) expect([width >= 155, height >= 98]).toEqual([true, true]);
  const texts = (await page.evaluate(readTexts)).map((one) => one.texts.map(({ text }) => text).join(" "));
  expect(new Set(texts).size, "the same numbers at all axes").toBe(1);
  await shot(page, "plot-multiples");
  const exported = await downloaded(page, () => choose(page, "Menu of this plot", "Export SVG"));
  const svg = readFileSync(await exported.path(), "utf8");
  keep("plot-multiples.svg", svg);
  for (const name of ["u0", "u19"]) expect(svg).toContain(`>${name}</text>`);
  await page.setViewportSize({ width: 1280, height: 800 });
});

test("axis, interaction kernel and time windows are edited in the plot that shows them", async () => {
  const { page } = studio;
  await reopen(page, observer, "edited.json");
  const axis = () => observer.document?.axes[0];
  const before = axis()?.upper;
  // a click on the axis itself
  const drawn = await settled(page, () => plot("Curves of u").locator(".plot-axis").first().boundingBox());
  if (drawn === null) throw new Error("the plot has no axis");
  await page.mouse.click(drawn.x + drawn.width / 2, drawn.y + drawn.height / 2);
  const upper = page.getByRole("textbox", { name: "To of the axis x", exact: true });
  await upper.fill("80");
  await upper.press("Enter");
  await observer.until(() => axis()?.upper === 80);
  await shot(page, "plot-axis");
  await upper.fill("-5");
  await upper.press("Enter");
  await page.getByRole("region", { name: "Axis x" }).getByRole("alert").waitFor();
  expect(axis()?.upper).toBe(80);
  await page.keyboard.press("Escape");
  await page.keyboard.press("Escape");
  await page.getByRole("dialog").waitFor({ state: "detached" });
  await observer.ask({ type: "undo" });
  await observer.until(() => axis()?.upper === before);

  await plot("Curves of u").getByRole("button", { name: "Menu of this plot" }).click();
  await page.getByRole("menuitem", { name: "Interaction kernel", exact: true }).click();
  await edit("Interaction kernel of u", "u", "kernel.0.amplitude", 7);
  await shot(page, "plot-kernel-edit");
  await page.keyboard.press("Escape");
  await edit("Time course of left", "left", "windows.0.stop", 350);
  await shot(page, "plot-windows-edit");
});

/** Type a number into a parameter beside a plot. */
async function edit(name: string, element: string, parameter: string, value: number): Promise<void> {
  await plot(name).getByRole("button", { name: "Edit what this plot shows" }).click();
  const field = studio.page.getByRole("dialog").getByRole("textbox", { name: parameter, exact: true });
  await field.fill(String(value));
  await field.press("Enter");
  await observer.until(() => observer.value(element, parameter) === value);
}

test("a plot shows the time courses of a node and of another element", async () => {
  const { page } = studio;
  await reopen(page, observer, "node.json");
  const course = plot("Time course of u");
  await course.waitFor();
  await button(page, "Play").click();
  await observer.until(() => observer.max("u", "activation") > 0);
  await button(page, "Pause").click();
  await beside(page, "Settings of this plot", async (settings) => {
    await settings.getByRole("combobox", { name: "Element of the new curve" }).click();
    await settings.getByRole("option", { name: "off", exact: true }).click();
    await settings.getByRole("button", { name: "Add", exact: true }).click();
    await settings.getByRole("button", { name: "Already in this plot" }).waitFor();
  });
  await chart("Time course of u", "activation, off output over time").waitFor();
  await shot(page, "plot-course");

  await choose(page, "Menu of this plot", "Phase plot");
  const phase = plot("Phase plot of u");
  const drawing = chart("Phase plot of u", "rate of change (1/ms) over activation of u");
  await expect.poll(() => colours(drawing)).toBeGreaterThan(60);
  await shot(page, "plot-phase");
  const alone = await drawn(drawing);
  await button(page, "First frame").click();
  await expect.poll(() => drawn(drawing)).not.toBe(alone);
  await button(page, "Live").click();
  await beside(page, "Settings of this plot", async (settings) => {
    await settings.getByLabel("rate of change of the other axis").uncheck();
    await settings.getByRole("combobox", { name: "Element of the vertical axis" }).click();
    await settings.getByRole("option", { name: "off", exact: true }).click();
  });
  await phase.getByRole("img", { name: "off output over activation of u" }).waitFor();
});

test("a field over two dimensions is a heat map with a scale; a sensor shows its picture", async () => {
  const { page } = studio;
  await reopen(page, observer, "saliency.json");
  await step(3);
  const map = plot("Heat map of spatial");
  await expect.poll(() => colours(map.locator("canvas.plot-heat"))).toBeGreaterThan(5);
  const bar = map.getByRole("img", { name: "activation of spatial as colours over x and y" });
  await expect.poll(() => colours(bar)).toBeGreaterThan(50);
  // 40 x 40 samples at the same distance are a square
  const square = await settled(page, () => map.locator(".plot-over").boundingBox());
  expect(Math.abs((square?.width ?? 0) - (square?.height ?? Infinity))).toBeLessThan(2.5);
  await map.getByRole("button", { name: "Menu of this plot" }).click();
  const exported = await downloaded(page, () => page.getByRole("menuitem", { name: "Export SVG" }).click());
  const svg = readFileSync(await exported.path(), "utf8");
  keep("plot-heat.svg", svg);
  expect(svg.match(/<image [^>]*href="data:image\/png;base64,/g), "the values are an image").toHaveLength(1);
  await map.getByRole("combobox", { name: "Port of spatial" }).selectOption("input");
  await map.getByRole("img", { name: "input of spatial as colours over x and y" }).waitFor();

  await button(page, "Open panels and plots").click();
  await page.getByRole("menuitem", { name: "eye", exact: true }).click();
  const picture = plot("Picture of eye").getByRole("img", { name: "Picture at output of eye" });
  await expect.poll(() => colours(picture)).toBeGreaterThan(2);
  await shot(page, "plot-heat");
});

test("a field over three axes is cut at a position, and any two axes are drawn", async () => {
  const { page } = studio;
  await reopen(page, observer, "saliency.json");
  await choose(page, "Open panels and plots", "perceptual");
  const map = plot("Heat map of perceptual");
  const canvas = map.locator("canvas.plot-heat");
  await step(3);
  await expect.poll(() => colours(canvas)).toBeGreaterThan(5);
  const whole = await drawn(canvas);
  const thumb = map.getByRole("slider", { name: "Position on hue" });
  const highest = map.getByRole("button", { name: "max over hue" });
  expect(await highest.getAttribute("aria-pressed")).toBe("true");
  await thumb.press("ArrowRight");
  await expect.poll(() => highest.getAttribute("aria-pressed")).toBe("false");
  await expect.poll(() => drawn(canvas)).not.toBe(whole);
  await observer.until(() => arranged().includes('"at":{"hue":'));
  const cut = await drawn(canvas);
  await thumb.press("Home");
  await expect.poll(() => drawn(canvas)).not.toBe(cut);
  await shot(page, "plot-section");
  const end = await drawn(canvas);
  await highest.click();
  await expect.poll(() => drawn(canvas)).not.toBe(end);
  await observer.until(() => arranged().includes('"at":{}'));

  await map.getByRole("button", { name: "Settings of this plot" }).click();
  const settings = page.getByRole("dialog");
  await settings.getByRole("combobox", { name: "To the right" }).selectOption("hue");
  await page.keyboard.press("Escape");
  await map.getByRole("img", { name: "activation of perceptual as colours over hue and y" }).waitFor();
  await map.getByRole("slider", { name: "Position on x" }).waitFor();
  await map.getByRole("button", { name: "Menu of this plot" }).click();
  await page.getByRole("menuitem", { name: "Curves", exact: true }).click();
  const curves = plot("Curves of perceptual");
  await curves.getByRole("img", { name: "activation, output of perceptual over hue" }).waitFor();
  await curves.getByRole("slider", { name: "Position on y" }).press("Home");
  await observer.until(() => arranged().includes('"at":{"y":'));
  await shot(page, "plot-section-curve");
});

test("a field is a surface, and one over three axes is cut by three planes", async () => {
  const { page } = studio;
  const chunks = () =>
    page.evaluate(() =>
      performance.getEntriesByType("resource").filter(({ name }) => /\/sceneStage-[^/]*\.js/.test(name)),
    );
  await reopen(page, observer, "saliency.json");
  await step(60);
  expect(await chunks(), "three.js is loaded when it is needed").toHaveLength(0);
  await choose(page, "Menu of this plot", "Surface");
  const surface = plot("Surface of spatial");
  const scene = surface.getByRole("img", { name: "activation of spatial as a surface over x and y" });
  await expect.poll(() => shades(scene)).toBeGreaterThan(20);
  expect(await chunks()).toHaveLength(1);
  const before = await drawn(scene);
  await surface.getByRole("group", { name: /arrow keys turn/ }).press("ArrowLeft");
  await expect.poll(() => drawn(scene)).not.toBe(before);
  await observer.until(() => arranged().includes('"azimuth"'));
  const exported = await downloaded(page, () => choose(page, "Menu of this plot", "Export SVG"));
  const svg = readFileSync(await exported.path(), "utf8");
  keep("plot-surface.svg", svg);
  expect(svg.match(/<image /g)).toHaveLength(1);
  for (const text of ["x", "y", "activation"]) expect(svg).toContain(`>${text}</text>`);
  await shot(page, "plot-surface");

  await choose(page, "Open panels and plots", "perceptual");
  await plot("Heat map of perceptual").getByRole("button", { name: "Menu of this plot" }).click();
  await page.getByRole("menuitem", { name: "Volume slices" }).click();
  const volume = plot("Volume slices of perceptual");
  const slices = volume.getByRole("img", { name: "Slices of activation of perceptual over x, y, hue" });
  await expect.poll(() => shades(slices)).toBeGreaterThan(20);
  const walls = await drawn(slices);
  await volume.getByRole("slider", { name: "Position on hue" }).press("ArrowRight");
  await expect.poll(() => drawn(slices)).not.toBe(walls);
  await shot(page, "plot-volume");
});

test("a browser without WebGL says so where a surface would be", async () => {
  const { page } = studio;
  await reopen(page, observer, "saliency.json");
  await step(3);
  await page.evaluate(() => {
    const asked = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, kind: string) {
      return kind === "webgl2" ? null : asked.call(this, kind);
    } as typeof asked;
  });
  await choose(page, "Menu of this plot", "Surface");
  await plot("Surface of spatial").getByText("This browser has no WebGL").waitFor();
  await choose(page, "Menu of this plot", "Heat map");
  await expect
    .poll(() => colours(plot("Heat map of spatial").locator("canvas.plot-heat")))
    .toBeGreaterThan(5);
  await page.reload();
});

test("the plots are kept in a reload and in the file", async () => {
  const { page, folder } = studio;
  const original = readFileSync(join(folder, "selection.json"), "utf8");
  expect(original).not.toContain("tiles");
  await button(page, "Open panels and plots").click();
  await page.getByLabel("Find a panel, or an element to plot").fill("lef");
  await page.getByRole("menuitem", { name: "left", exact: true }).click();
  await plot("Curves of left").waitFor();
  await observer.until(() => arranged().includes(observer.element("left").id));
  expect(observer.document?.unsaved, "which plots are open is nothing to ask about").toBe(false);

  await page.reload();
  await plot("Curves of left").waitFor();
  await observer.ask({ type: "save", path: "arranged.json" });
  expect(readFileSync(join(folder, "arranged.json"), "utf8")).toContain('"tiles"');
  await reopen(page, observer, "node.json");
  await plot("Time course of u").waitFor();
  await reopen(page, observer, "arranged.json");
  await plot("Curves of left").waitFor();
});

test("a plot is exported as a picture file", async () => {
  const { page } = studio;
  await step(300);
  await plot("Curves of u").getByText("Press play").waitFor({ state: "detached" });
  const download = await downloaded(page, () => choose(page, "Menu of this plot", "Export PNG"));
  expect(download.suggestedFilename()).toBe("u.png");
  const png = readFileSync(await download.path());
  expect(png.subarray(0, 8).toString("latin1")).toBe("\x89PNG\r\n\x1a\n");
  const drawn = await plot("Curves of u").locator(".plot-canvas").boundingBox();
  const [width, height] = [png.readUInt32BE(16), png.readUInt32BE(20)];
  expect(width).toBeGreaterThanOrEqual(2 * Math.floor(drawn?.width ?? Infinity) - 2);
  expect(height).toBeGreaterThan(2 * (drawn?.height ?? Infinity) - 2);
  expect(png.length).toBeGreaterThan(5000);

  const vectors = await downloaded(page, () => choose(page, "Menu of this plot", "Export SVG"));
  expect(vectors.suggestedFilename()).toBe("u.svg");
  const svg = readFileSync(await vectors.path(), "utf8");
  keep("plot-curves.svg", svg);
  const size = /<svg [^>]*width="([\d.]+)" height="([\d.]+)"/.exec(svg) ?? [];
  expect([Number(size[1]), Number(size[2])]).toEqual([width / 2, height / 2]);
  for (const text of ["x (deg)", "threshold 0", "activation"]) expect(svg).toContain(`>${text}</text>`);
  expect(svg).not.toContain("<image");
  const lines = [...svg.matchAll(/ d="([^"]*)"/g)].map(([, d = ""]) => d.split("L").length);
  expect(
    lines.filter((points) => points > 60),
    "output; activation below and above the threshold, and its glow",
  ).toHaveLength(4);
});

test("the right button, a finger and the key I make a peak while they are held", async () => {
  const { page } = studio;
  for (const path of ["left", "right"]) {
    await observer.ask({ type: "set", element: observer.element(path).id, parameter: "amplitude", value: 0 });
  }
  await observer.ask({ type: "play" });
  await observer.until(() => observer.max("u", "activation") < 0);
  const over = plot("Curves of u").locator(".plot-over");
  const place = await over.boundingBox();
  if (place === null) throw new Error("The plot is not visible.");
  const pushing = () => observer.clock?.pushing === observer.element("u").id;
  // Panels still move for a moment after a document is opened: press again, as a user would, if a press
  // went beside the plot.
  for (let tries = 0; tries < 20 && !pushing(); tries++) {
    await page.mouse.up({ button: "right" });
    await over.hover({ position: { x: place.width * 0.25, y: place.height / 2 } });
    await page.mouse.down({ button: "right" });
    await page.waitForTimeout(500);
  }
  await observer.until(pushing);
  await observer.until(() => observer.max("u", "activation") > 3);
  expect(Math.abs(observer.peak("u", "activation") - 25)).toBeLessThan(6);
  await shot(page, "plot-injection");
  await page.mouse.up({ button: "right" });
  await observer.until(() => observer.clock?.pushing === "");
  await observer.until(() => observer.max("u", "activation") < 0);

  await page.mouse.move(place.x + place.width * 0.75, place.y + place.height / 2);
  await plot("Curves of u").getByRole("group", { name: "Drawing of u; hold I to inject" }).focus();
  await page.keyboard.down("i");
  await observer.until(() => observer.max("u", "activation") > 3);
  await page.keyboard.up("i");
  await observer.until(() => observer.clock?.pushing === "");
  await observer.until(() => observer.max("u", "activation") < 0);

  await page.keyboard.down("Shift");
  await page.mouse.down({ button: "right" });
  await observer.until(() => pushing() && observer.max("u", "activation") > 0);
  await page.mouse.up({ button: "right" });
  await page.keyboard.up("Shift");
  await observer.until(() => observer.clock?.pushing === "");
  await observer.until(() => observer.max("u", "activation") < 0);

  const screen = await page.context().newCDPSession(page);
  const finger = { x: place.x + place.width * 0.25, y: place.y + place.height / 2 };
  await screen.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: [finger] });
  await observer.until(() => pushing() && observer.max("u", "activation") > 3);
  expect(Math.abs(observer.peak("u", "activation") - 25)).toBeLessThan(6);
  await screen.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
  await observer.until(() => observer.clock?.pushing === "");
  await screen.detach();
});
