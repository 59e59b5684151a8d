import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { box, button, colours, panel, reopen, select, showEverything } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({ copies: ["examples/groups.json"], file: "groups.json" });
  // all names and numbers have room
  await studio.page.setViewportSize({ width: 2000, height: 1500 });
  observer = await studio.observe();
  await observer.runs();
});

// Nothing is selected, and everything is visible.
beforeEach(async () => {
  await showEverything(studio.page);
});

afterAll(() => studio.stop());

type Boxes = Record<string, { x: number; y: number }>;

const canvas = () => panel(studio.page, "Architecture");
const boxes = () => (observer.document?.layout["boxes"] ?? {}) as Boxes;
const place = (path: string) => boxes()[observer.element(path).id];
const inspected = (name: string) =>
  panel(studio.page, "Inspector").getByRole("heading", { name, exact: true });

/** The zoom factor of the canvas. */
const zoom = () =>
  canvas()
    .locator(".react-flow__viewport")
    .evaluate((viewport) => new DOMMatrix(getComputedStyle(viewport).transform).a);

test("elements are boxes with name and kind, couplings are drawn on their edges", async () => {
  const { page } = studio;
  for (const path of ["search.intention", "search.satisfied", "lift.intention", "start"])
    await box(page, path).waitFor();
  expect(await box(page, "search.intention").innerText()).toMatch(/intention/);
  expect(await box(page, "search.intention").getAttribute("aria-label")).toMatch(/, Field$/);
  expect(await box(page, "search.intention").locator(".graph-dimensions").textContent()).toBe("0-D");
  expect(await box(page, "search.expects").count(), "a coupling is no box").toBe(0);
  // a canvas that is zoomed out shows the number of a coupling without its name
  const strength = page.getByRole("spinbutton", { name: "Strength of search.expects" });
  expect(await strength.getAttribute("aria-valuenow")).toBe("2.5");
  await strength.click();
  await page.keyboard.press("Escape");
  await inspected("expects").waitFor();
  const pill = page.locator(".graph-pill", { has: strength });
  expect(await pill.getAttribute("data-selected")).toBe("true");
  await select(page, "start");
  await expect.poll(() => pill.getAttribute("data-selected")).toBeNull();
  await shot(page, "graph");
});

test("a document without anything to plot is visible as soon as it is opened", async () => {
  const { page, folder } = studio;
  const spot = { kind: "GaussianStimulus", id: "00000001", axes: ["x"], center: 5, sigma: 2, amplitude: 1 };
  const axes = { x: { name: "x", lower: 0, upper: 10, samples: 11 } };
  writeFileSync(
    join(folder, "spot.json"),
    JSON.stringify({ deodar: 1, name: "spot", axes, elements: { spot } }),
  );
  await reopen(page, observer, "spot.json");
  await box(page, "spot").waitFor();
  await expect.poll(zoom).toBeGreaterThan(1);
  await select(page, "spot");
  await reopen(page, observer, "groups.json");
});

test("the names of edges state the elements that they connect", async () => {
  await canvas()
    .getByRole("img", { name: "search.intention to search.satisfied", exact: true })
    .waitFor({ state: "attached" });
});

test("excitation and inhibition differ in their marks and lines, not only in colour", async () => {
  const look = (name: string) =>
    canvas()
      .getByRole("img", { name, exact: true })
      .locator(".graph-wire")
      .evaluate((path) => {
        const mark = /#([\w-]+)/.exec(path.getAttribute("marker-end") ?? "")?.[1] ?? "";
        return {
          mark: document.getElementById(mark)?.innerHTML,
          dash: getComputedStyle(path).strokeDasharray,
        };
      });
  const [excites, inhibits] = [
    await look("search.intention to search.satisfied"),
    await look("search.satisfied to search.intention, inhibition"),
  ];
  expect(excites.mark).toContain("path");
  expect(excites.dash).toBe("none");
  expect(inhibits.mark).toContain("circle");
  expect(inhibits.dash).toMatch(/^\d/);
});

test("a source has rounder corners than what has inputs, and no colour of its own", async () => {
  const { page } = studio;
  await observer.ask({ type: "new", discard: true });
  const kinds = ["GaussianStimulus", "Field", "Product"];
  for (const [i, kind] of kinds.entries())
    await observer.ask({ type: "add_element", kind, name: kind.toLowerCase(), at: [250 * i, 0] });
  await box(page, "product").waitFor();
  await showEverything(page);
  const corners = (kind: string) =>
    box(page, kind.toLowerCase())
      .locator(".graph-box")
      .evaluate((element) => parseFloat(getComputedStyle(element).borderTopLeftRadius));
  await shot(page, "graph-sources");
  const [source, field, coupling] = await Promise.all(kinds.map(corners));
  expect([field, coupling]).toEqual([10, 10]);
  expect(source).toBe(14);
  await reopen(page, observer, "groups.json");
});

test("a group folds into one box, stays folded when the page is reloaded, and unfolds", async () => {
  const { page } = studio;
  await button(page, "Fold search").click();
  const folded = page.getByRole("group", { name: /^Group search, folded, / });
  await folded.waitFor();
  await box(page, "search.intention").waitFor({ state: "detached" });
  await page.reload();
  await folded.waitFor();
  expect(await box(page, "search.intention").count()).toBe(0);
  await button(page, "Unfold search").click();
  await box(page, "search.intention").waitFor();
  await folded.waitFor({ state: "detached" });
});

test("a dragged box keeps its position, also in the file", async () => {
  const { page, folder } = studio;
  await box(page, "start").hover({ trial: true, position: { x: 20, y: 10 } });
  const before = await box(page, "start").boundingBox();
  if (before === null) throw new Error("The box is not visible.");
  const [x, y] = [before.x + before.width / 3, before.y + 10];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 30, y + 25, { steps: 6 });
  await page.mouse.up();
  await observer.until(() => place("start"));
  const put = place("start");
  const after = await box(page, "start").boundingBox();
  expect(after?.x).toBeGreaterThan(before.x + 15);
  expect(after?.y).toBeGreaterThan(before.y + 10);
  await page.keyboard.press("Control+s");
  await page.getByText("Saved as groups.json").waitFor();
  const kept = JSON.parse(readFileSync(join(folder, "groups.json"), "utf8")) as { layout: { boxes: Boxes } };
  expect(kept.layout.boxes[observer.element("start").id]).toEqual(put);

  await page.keyboard.press("Control+z");
  await observer.until(() => place("start") === undefined);
  await page.keyboard.press("Control+Shift+z");
  await observer.until(() => place("start") !== undefined);
});

test("search finds an element, selects it and scrolls to it", async () => {
  const { page } = studio;
  await page.keyboard.press("Control+f");
  const field = page.getByRole("combobox", { name: "Search for an element" });
  await field.fill("no such thing");
  await page.getByText("No element matches").waitFor();
  await field.fill("lift sat");
  await page.getByRole("option", { name: /lift\.satisfied/ }).waitFor();
  await field.press("Enter");
  await inspected("satisfied").waitFor();
  await panel(page, "Inspector")
    .getByRole("navigation", { name: "Path of the element" })
    .getByText("/ lift")
    .waitFor();
  await box(page, "lift.satisfied").waitFor();
  await field.waitFor({ state: "detached" });

  await button(page, "Search (Ctrl+F)").click();
  await field.fill("search.ends");
  await page.getByRole("option", { name: /search\.ends/ }).click();
  await inspected("ends").waitFor();
});

test("the card of an element shows its equation and its values", async () => {
  const { page } = studio;
  const card = page.getByRole("tooltip").filter({ hasText: "grasp.intention" });
  // a canvas that still moves hides the card
  await expect
    .poll(
      async () => {
        await page.mouse.move(0, 0);
        await box(page, "grasp.intention").hover({ position: { x: 20, y: 12 } });
        return card.waitFor({ timeout: 3000 }).then(
          () => true,
          () => false,
        );
      },
      { interval: 0 },
    )
    .toBe(true);
  await card.locator(".katex").first().waitFor();
  expect(await card.getByRole("math").count()).toBeGreaterThan(0);
  expect(await card.innerText()).toMatch(/20 ms/);
  await shot(page, "graph-card");
  await page.keyboard.press("Escape");
  await card.waitFor({ state: "detached" });
});

test("the canvas zooms in, out and to the whole graph; a map shows the whole graph", async () => {
  const { page } = studio;
  await expect.poll(() => box(page, "lift done").count()).toBe(1);
  const whole = await zoom();
  await button(page, "Zoom in").click();
  await expect.poll(zoom).toBeGreaterThan(whole * 1.1);
  const large = await zoom();
  await button(page, "Zoom out").click();
  await expect.poll(zoom).toBeLessThan(large * 0.95);
  await showEverything(page);
  await expect.poll(zoom).toBeCloseTo(whole, 2);
  const map = page.getByRole("img", { name: "Overview of the canvas" });
  await map.waitFor();
  expect(await map.locator(".react-flow__minimap-node").count()).toBeGreaterThanOrEqual(13);
});

test("each box shows a live picture while the model runs", async () => {
  const { page } = studio;
  await button(page, "Play").click();
  await observer.until(() => observer.max("search.intention", "activation") > 0);
  for (const path of ["search.intention", "lift.satisfied"]) {
    await expect
      .poll(() => colours(page.getByRole("img", { name: `activation of ${path}, live` })))
      .toBeGreaterThan(2);
  }
  await shot(page, "graph-live");
  await button(page, "Pause").click();
});

test("boxes are reached, selected and moved by keyboard", async () => {
  const { page } = studio;
  await box(page, "start").focus();
  await page.keyboard.press("Enter");
  await inspected("start").waitFor();
  const before = place("start");
  await page.keyboard.press("ArrowDown");
  await observer.until(() => (place("start")?.y ?? 0) > (before?.y ?? 0));
});

test("a double click on a box plots it", async () => {
  const { page } = studio;
  await box(page, "approach.intention").dblclick({ position: { x: 20, y: 12 } });
  await page.getByRole("region", { name: "Time course of approach.intention" }).waitFor();
});
