import type { Locator } from "playwright-core";
import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { obstacles } from "./axe";
import { box, button, file, openEmpty, panel, showEverything } from "./hands";
import type { Observer } from "./observer";
import { runScript } from "./server";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio();
  observer = await studio.observe();
});

// Each test begins with an empty document.
beforeEach(async () => {
  await openEmpty(studio.page, observer);
});

afterAll(() => studio.stop());

const palette = (): Locator => studio.page.getByRole("dialog", { name: "Add an element" });
const search = (): Locator => palette().getByRole("combobox", { name: "Add an element" });
const option = (name: string): Locator => palette().getByRole("option", { name, exact: true });
const inspected = (name: string): Promise<void> =>
  panel(studio.page, "Inspector").getByRole("heading", { name, exact: true }).waitFor();
const kinds = (): string[] => (observer.document?.elements ?? []).map(({ kind }) => kind);

/** A place of the empty ground, as a share of the canvas. */
async function ground(across: number, down: number): Promise<{ x: number; y: number }> {
  const pane = studio.page.locator(".react-flow__pane");
  // a document that was opened just now replaces the canvas
  await expect.poll(async () => (await pane.boundingBox()) !== null).toBe(true);
  const all = await pane.boundingBox();
  if (all === null) throw new Error("The canvas is not visible.");
  return { x: all.x + all.width * across, y: all.y + all.height * down };
}

/** The same place, from the corner of the canvas. */
async function inPane({ x, y }: { x: number; y: number }): Promise<{ x: number; y: number }> {
  const all = await studio.page.locator(".react-flow__pane").boundingBox();
  return { x: x - (all?.x ?? 0), y: y - (all?.y ?? 0) };
}

test("the gallery and the file menu open an empty document", async () => {
  const { page } = studio;
  await file(page, /^Close/);
  await button(page, "Empty document").click();
  await page.getByText("This document has no elements yet.").waitFor();
  expect(observer.document?.elements).toEqual([]);
  await shot(page, "palette-empty");
  await file(page, "New");
  await page.getByText("This document has no elements yet.").waitFor();
});

test("a double click on the ground adds the element that is clicked, at the pointer", async () => {
  const { page } = studio;
  const at = await ground(0.3, 0.4);
  await page.mouse.dblclick(at.x, at.y);
  await option("Gaussian stimulus").waitFor();
  await palette().locator(".katex").first().waitFor();
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "palette-open");
  await option("Field, 1-D").click();
  await box(page, "field").waitFor();
  await inspected("field");
  const found = await box(page, "field").boundingBox();
  expect(found?.x).toBeLessThan(at.x);
  expect((found?.x ?? 0) + (found?.width ?? 0)).toBeGreaterThan(at.x);
  expect(Math.abs((found?.y ?? 0) - at.y)).toBeLessThan(40);
  await shot(page, "palette-added");
});

test("a sensor from the palette senses a world at once", async () => {
  const { page } = studio;
  const at = await ground(0.3, 0.4);
  await page.mouse.dblclick(at.x, at.y);
  await search().fill("sensor");
  await option("Sensor").click();
  await box(page, "sensor").waitFor();
  await inspected("sensor");
  await button(page, "World: Picture: an example; choose another one").waitFor();
  await observer.runs();
  expect(observer.document?.problems).toEqual([]);
});

test("the keyboard alone finds, adds and undoes", async () => {
  const { page } = studio;
  await page.keyboard.press("/");
  await search().pressSequentially("gau");
  await page.keyboard.press("Enter");
  await observer.until(() => kinds().join() === "GaussianStimulus");
  await palette().waitFor({ state: "detached" });
  await inspected("gaussian_stimulus");
  await expect
    .poll(() => page.evaluate(() => document.activeElement?.getAttribute("aria-label")))
    .toMatch(/^gaussian_stimulus, /);
  await page.keyboard.press("Control+z");
  await observer.until(() => kinds().length === 0);
});

test("Escape closes the palette, and so does a press beside it", async () => {
  const { page } = studio;
  const at = await ground(0.2, 0.2);
  await page.mouse.click(at.x, at.y, { button: "right" });
  await palette().waitFor();
  await page.keyboard.press("Escape");
  await palette().waitFor({ state: "detached" });
  await page.mouse.move(at.x, at.y);
  await page.keyboard.press("Tab");
  await palette().waitFor();
  const beside = await ground(0.9, 0.05);
  await page.mouse.click(beside.x, beside.y);
  await palette().waitFor({ state: "detached" });
  expect(kinds()).toEqual([]);
});

test("kernels are added to the selected field, and state what they need without one", async () => {
  const { page } = studio;
  await page.keyboard.press("/");
  await search().fill("mexican hat");
  const hat = palette().getByRole("option", { name: /^Mexican hat/ });
  expect(await hat.getAttribute("aria-disabled")).toBe("true");
  await hat.getByText("Select an element that has kernels").waitFor();
  await search().fill("field");
  await page.keyboard.press("Enter");
  await inspected("field");
  await page.keyboard.press("/");
  await search().fill("mexican hat");
  await page.keyboard.press("Enter");
  await observer.until(
    () => (observer.value("field", "kernel") as { kind: string }[]).at(-1)?.kind === "MexicanHat",
  );
});

test("the list of elements is a panel: a line is dragged to the canvas, or clicked", async () => {
  const { page } = studio;
  await button(page, "Open panels and plots").click();
  await page.getByRole("menuitem", { name: "Elements", exact: true }).click();
  const list = panel(page, "Elements");
  await list.getByRole("option", { name: "Field, 1-D", exact: true }).click();
  await box(page, "field").waitFor();
  const at = await ground(0.2, 0.75);
  await list.getByRole("option", { name: "Box stimulus", exact: true }).scrollIntoViewIfNeeded();
  const line = await list.getByRole("option", { name: "Box stimulus", exact: true }).boundingBox();
  await page.mouse.move((line?.x ?? 0) + 60, (line?.y ?? 0) + 12);
  await page.mouse.down();
  await page.mouse.move(at.x - 20, at.y - 20, { steps: 4 });
  await page.mouse.move(at.x, at.y, { steps: 4 });
  await page.mouse.up();
  await box(page, "box_stimulus").waitFor();
  await shot(page, "palette-panel");
  expect(kinds().sort()).toEqual(["BoxStimulus", "Field"]);
});

test("the palette lists every registered kind, each with a sketch", async () => {
  const { page } = studio;
  const registered = JSON.parse(await runScript("kind_titles")) as string[];
  await page.keyboard.press("/");
  await option("Gaussian stimulus").waitFor();
  const lines = await palette()
    .locator("[role=group]:not([aria-label^='Sensors and motors of']) [role=option]")
    .evaluateAll((all) =>
      all.map((line) => {
        const path = line.querySelector<SVGGraphicsElement>("svg path, svg text");
        const { width = 0, height = 0 } = path?.getBBox() ?? {};
        const title = line.querySelector(".one-line")?.textContent ?? "";
        return {
          title,
          sketched: line.querySelector("svg:not(.chooser-thumbnail)") !== null,
          drawn: width + height > 5,
        };
      }),
    );
  const kinds = lines.filter(({ sketched }) => sketched);
  const titles = new Set(kinds.map(({ title }) => title.replace(/, [123]-D$/, "")));
  expect([...titles].sort()).toEqual(registered.sort());
  const blank = kinds.filter(({ drawn }) => !drawn).map(({ title }) => title);
  expect(blank, "without a sketch").toEqual([]);
  await page.keyboard.press("Escape");
});

test("a line of the palette that is dropped on a connection is inserted into it", async () => {
  const { page } = studio;
  const add = (kind: string, name: string, at: [number, number], values = {}) =>
    observer.ask({ type: "add_element", kind, name, at, values });
  await add("RateNode", "one", [0, 0]);
  await add("RateNode", "other", [400, 0]);
  const [source, target] = [observer.element("one").id, observer.element("other").id];
  await observer.ask({ type: "connect", source, target });
  await button(page, "Open panels and plots").click();
  await page.getByRole("menuitem", { name: "Elements", exact: true }).click();
  await showEverything(page);
  const wire = page.getByRole("img", { name: "one to other", exact: true });
  await wire.waitFor();
  const at = await wire.locator(".graph-wire").evaluate((path: SVGPathElement) => {
    const { x, y } = path.getPointAtLength(path.getTotalLength() / 2);
    return new DOMPoint(x, y).matrixTransform(path.getScreenCTM() as DOMMatrix).toJSON() as DOMPoint;
  });
  const line = panel(page, "Elements").getByRole("option", { name: "Field, 1-D", exact: true });
  await line.scrollIntoViewIfNeeded();
  const from = await line.boundingBox();
  await page.mouse.move((from?.x ?? 0) + 60, (from?.y ?? 0) + 12);
  await page.mouse.down();
  await page.mouse.move(at.x - 20, at.y - 20, { steps: 4 });
  await page.mouse.move(at.x, at.y, { steps: 4 });
  await page.locator(".graph-wire[data-picked]").waitFor();
  await page.mouse.up();
  await observer.until(() => {
    const ends = observer.document?.connections.map((c) => [c.source, c.target]) ?? [];
    const between = observer.document?.elements.find(({ kind }) => kind === "Field")?.id;
    return (
      ends.length === 2 &&
      ends.some(([from, to]) => from === source && to === between) &&
      ends.some(([from, to]) => from === between && to === target)
    );
  });
});

test("architectures are added whole: entered at the pointer, or dragged from the panel", async () => {
  const { page } = studio;
  const at = await ground(0.3, 0.3);
  await page.mouse.move(at.x, at.y);
  await page.keyboard.press("/");
  await search().fill("behaviour one");
  await palette().getByText("One behaviour, to be inserted as a group").waitFor();
  await page.keyboard.press("Enter");
  await box(page, "behaviour.intention").waitFor();
  await observer.until(() => observer.document?.groups.join() === "behaviour");
  const first = await box(page, "behaviour.task").boundingBox();
  expect(Math.abs((first?.x ?? 0) - at.x)).toBeLessThan(200);

  await page.keyboard.press("/");
  await search().fill("working memory");
  await expect
    .poll(() =>
      palette()
        .locator("img.chooser-picture")
        .evaluate((img: HTMLImageElement) => img.naturalWidth),
    )
    .toBeGreaterThan(0);
  await shot(page, "palette-template");
  await page.keyboard.press("Escape");

  await button(page, "Open panels and plots").click();
  await page.getByRole("menuitem", { name: "Elements", exact: true }).click();
  const list = panel(page, "Elements");
  await list.getByRole("combobox").fill("working memory");
  const down = await ground(0.2, 0.8);
  await list.getByRole("option", { name: "Working memory" }).dragTo(page.locator(".react-flow__pane"), {
    targetPosition: await inPane(down),
  });
  await box(page, "working_memory.cue").waitFor();
  await page.keyboard.press("Control+z");
  await observer.until(() => observer.document?.groups.length === 1);
});

test("the palette is legible in both colour schemes and on a narrow page", async () => {
  const { page } = studio;
  for (const [width, colours] of [
    [1280, "dark"],
    [640, "light"],
  ] as const) {
    await page.emulateMedia({ colorScheme: colours });
    await page.setViewportSize({ width, height: 800 });
    await page.keyboard.press("/");
    await search().fill("gau");
    await palette().locator(".katex").first().waitFor();
    await shot(page, `palette-${width}-${colours}`);
    const found = await palette().boundingBox();
    expect(found?.x).toBeGreaterThanOrEqual(0);
    expect((found?.x ?? 0) + (found?.width ?? 0)).toBeLessThanOrEqual(width);
    for (const line of await palette().getByRole("option").all())
      expect((await line.boundingBox())?.height).toBeGreaterThanOrEqual(24);
    await page.keyboard.press("Escape");
    await palette().waitFor({ state: "detached" });
  }
  await page.emulateMedia({ colorScheme: "light" });
  await page.setViewportSize({ width: 1280, height: 800 });
});
