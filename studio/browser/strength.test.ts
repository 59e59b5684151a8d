/** The strength of a connection on its wire: dragged, typed, by keys, and in the inspector. */
import type { Locator } from "playwright-core";
import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { box, button, number, openEmpty, panel, settled, showEverything, slider, type } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio();
  observer = await studio.observe();
});

afterAll(() => studio.stop());

// Two fields over x, saccade -> decision.
beforeEach(async () => {
  const { page } = studio;
  await page.mouse.move(5, 400);
  await openEmpty(page, observer);
  const add = async (name: string, at: [number, number]) =>
    (await observer.ask({ type: "add_element", kind: "Field", name, at })).made?.[0] ?? "";
  const [source, target] = [await add("saccade", [0, 0]), await add("decision", [420, 0])];
  await observer.ask({ type: "connect", source, target });
  await observer.until(() => observer.document?.connections.length === 1);
  await box(page, "decision").waitFor();
  await showEverything(page);
  await observer.runs();
});

const wire = (): Locator => studio.page.locator(".react-flow__edge");
const chip = (): Locator => studio.page.getByRole("spinbutton", { name: /^Strength, saccade → decision, / });
const factor = (): unknown =>
  observer.document?.elements.find(({ kind }) => kind === "Gain")?.values["factor"];
const text = async (): Promise<string> => {
  const { text: copied = "" } = await observer.ask({
    type: "copy",
    elements: observer.document?.elements.map(({ id }) => id) ?? [],
  });
  return copied;
};

async function middle(locator: Locator): Promise<{ x: number; y: number }> {
  const found = await locator.boundingBox();
  if (found === null) throw new Error("It is not visible.");
  return { x: found.x + found.width / 2, y: found.y + found.height / 2 };
}

/** Bring the strength 1 of the plain wire into view. */
async function hover(): Promise<void> {
  const { x, y } = await middle(wire().locator("path").first());
  await studio.page.mouse.move(x, y);
  await chip().waitFor();
}

/** Select the wire beside what is drawn on it. */
async function pick(): Promise<void> {
  const { x, y } = await wire()
    .locator("path")
    .first()
    .evaluate((path: SVGPathElement) => {
      const { x, y } = path.getPointAtLength(0.8 * path.getTotalLength());
      const { a, d, e, f } = path.getScreenCTM() as DOMMatrix;
      return { x: a * x + e, y: d * y + f };
    });
  await studio.page.mouse.click(x, y);
}

async function drag(pixels: number): Promise<void> {
  const { x, y } = await middle(chip());
  await studio.page.mouse.move(x, y);
  await studio.page.mouse.down();
  await studio.page.mouse.move(x + pixels / 2, y, { steps: 4 });
  await studio.page.mouse.move(x + pixels, y, { steps: 4 });
  await studio.page.mouse.up();
}

test("a drag by 40 px makes 3 of 1 as one step of undo, and 1 leaves the document as it was", async () => {
  const { page } = studio;
  const before = await text();
  const steps = observer.document?.undo ?? 0;
  expect(await chip().count()).toBe(0);
  await hover();
  expect(await chip().textContent()).toBe("1");
  await shot(page, "strength-hover");
  await drag(40);
  await observer.until(() => factor() === 3);
  await expect.poll(() => chip().textContent()).toBe("3");
  expect(observer.document?.undo).toBe(steps + 1);
  await page.mouse.move(5, 400);
  await shot(page, "strength-3");
  expect(await chip().isVisible(), "a strength other than 1 stays").toBe(true);
  await page.keyboard.press("Control+z");
  await observer.until(() => factor() === undefined);
  expect(await text()).toBe(before);
  await hover();
  await drag(40);
  await observer.until(() => factor() === 3);
  await drag(-40);
  await observer.until(() => factor() === undefined);
  expect(await text()).toBe(before);
});

test("typed -4 gives dashes and a dot, and 1 removes them", async () => {
  const { page } = studio;
  const before = await text();
  await hover();
  await chip().click();
  await page.keyboard.type("-4");
  await page.keyboard.press("Enter");
  await observer.until(() => factor() === -4);
  await expect.poll(() => chip().textContent()).toBe("−4");
  const path = page.locator(".graph-wire");
  await expect.poll(() => path.getAttribute("data-sign")).toBe("-");
  expect(await path.getAttribute("marker-end")).toContain("inhibition");
  expect(await path.evaluate((drawn) => getComputedStyle(drawn).strokeDasharray)).toBe("7px, 3px");
  await shot(page, "strength-inhibits");
  await chip().click();
  await page.keyboard.type("1");
  await page.keyboard.press("Enter");
  await observer.until(() => factor() === undefined);
  await expect.poll(() => path.getAttribute("data-sign")).toBe("+");
  expect(await text()).toBe(before);
});

test("a field that is clicked while a strength is typed has the focus, and the number is taken", async () => {
  const { page } = studio;
  await hover();
  await chip().click();
  await page.keyboard.type("2");
  const search = page.getByPlaceholder("Add an element");
  await search.click();
  await observer.until(() => factor() === 2);
  await chip().waitFor();
  expect(await search.evaluate((field) => field === document.activeElement)).toBe(true);
  await chip().click();
  await page.keyboard.type("two");
  await page.keyboard.press("Enter");
  await page.getByRole("region", { name: "Messages" }).getByText("needs a number, not two").waitFor();
  expect(factor()).toBe(2);
  expect(await chip().evaluate((drawn) => drawn === document.activeElement)).toBe(true);
  await page.getByRole("button", { name: "Dismiss" }).click();
});

test("a press that the browser cancels does not type", async () => {
  const { page } = studio;
  await hover();
  const { x, y } = await middle(chip());
  await page.mouse.move(x, y);
  await page.mouse.down();
  await chip().dispatchEvent("pointercancel");
  await page.mouse.up();
  await page.keyboard.press("ArrowUp");
  await observer.until(() => factor() === 1.1);
});

test("a strength that a document parameter drives changes the parameter", async () => {
  const { page } = studio;
  const { source, target } = observer.document?.connections[0] ?? { source: "", target: "" };
  const drive = (name: string, element: string, parameter: string) =>
    observer.ask({ type: "add_document_parameter", name, element, parameter });
  const value = (name: string) => observer.document?.parameters.find((other) => other.name === name)?.value;
  await hover();
  await drag(40);
  await observer.until(() => factor() === 3);
  await drive("drive", observer.document?.elements.find(({ kind }) => kind === "Gain")?.id ?? "", "factor");
  await observer.until(() => value("drive") === 3);
  await chip().focus();
  await page.keyboard.press("ArrowUp");
  await observer.until(() => value("drive") === 3.1);
  await drag(40);
  await observer.until(() => value("drive") === 5.1);
  const back = { source: target, target: source };
  await observer.ask({ type: "connect", ...back });
  const spread = { type: "add_element", kind: "Convolve", name: "spread", wire: back } as const;
  const { made = [] } = await observer.ask(spread);
  await drive("width", made[0] ?? "", "kernel.0.amplitude");
  await observer.until(() => value("width") !== undefined);
  const amplitude = value("width") as number;
  const pill = page.getByRole("spinbutton", { name: "Strength of spread", exact: true });
  await pill.focus();
  await page.keyboard.press("-");
  await observer.until(() => value("width") === -amplitude);
});

test("keys change the strength by 0.1 and flip its sign", async () => {
  const { page } = studio;
  await hover();
  await chip().focus();
  for (let n = 0; n < 5; n++) await page.keyboard.press("ArrowUp");
  await observer.until(() => factor() === 1.5);
  await page.keyboard.press("-");
  await observer.until(() => factor() === -1.5);
  await page.keyboard.press("ArrowLeft");
  await observer.until(() => factor() === -1.6);
  expect(await chip().evaluate((drawn) => drawn === document.activeElement)).toBe(true);
});

test("a selected wire fills the inspector and has a card with a slider", async () => {
  const { page } = studio;
  await pick();
  const inspector = panel(page, "Inspector");
  await inspector.getByRole("heading", { name: "saccade → decision", exact: true }).waitFor();
  const card = page.locator(".graph-wire-card");
  expect(await card.innerText()).toContain("saccade → decision, excites");
  await shot(page, "strength-selected");
  await type(page, "strength", "-4");
  await observer.until(() => factor() === -4);
  await expect.poll(() => card.innerText()).toContain("saccade → decision, inhibits");
  await inspector.getByText("Connection, inhibits").waitFor();
  const thumb = card.getByRole("slider");
  await thumb.focus();
  for (let n = 0; n < 50; n++) await page.keyboard.press("ArrowRight");
  await observer.until(() => factor() === undefined);
  expect(await number(page, "strength").inputValue()).toBe("1");
  await slider(page, "strength").focus();
  await page.keyboard.press("ArrowRight");
  await observer.until(() => factor() === 1.1);
  await inspector.getByRole("button", { name: "Insert an element" }).click();
  await page.getByRole("dialog", { name: "Insert an element" }).waitFor();
  await page.keyboard.press("Escape");
  await inspector.getByRole("button", { name: "decision", exact: true }).click();
  await inspector.getByRole("heading", { name: "decision", exact: true }).waitFor();
  await card.waitFor({ state: "detached" });
});

test("the amplitude of a kernel is the number of its wire", async () => {
  const { page } = studio;
  const [first] = observer.document?.connections ?? [];
  if (first === undefined) throw new Error("There is no connection.");
  const { source, target } = first;
  await observer.ask({ type: "add_element", kind: "Convolve", name: "spread", wire: { source, target } });
  const amplitude = page.getByRole("spinbutton", { name: "Strength of spread", exact: true });
  await amplitude.waitFor();
  await amplitude.focus();
  await page.keyboard.press("-");
  const path = page.locator(".graph-wire");
  await expect.poll(() => path.getAttribute("data-sign")).toBe("-");
  await shot(page, "strength-kernel");
  await page.getByRole("button", { name: /^spread/ }).click();
  await panel(page, "Inspector").getByRole("heading", { name: "spread", exact: true }).waitFor();
});

for (const kind of ["kernels", "weights"] as const) {
  test(`a connection with ${kind} has a strength that scales them together`, async () => {
    const { page } = studio;
    const { source, target } = observer.document?.connections[0] ?? { source: "", target: "" };
    const wired = { type: "add_element", name: "spread", wire: { source, target } } as const;
    const kernel = (amplitude: number) => ({ kind: "Gaussian", amplitude });
    await observer.ask(
      kind === "kernels"
        ? { ...wired, kind: "Convolve", values: { kernel: [kernel(8), kernel(-3)] } }
        : { ...wired, kind: "Weights" },
    );
    await page.locator(".graph-pill", { hasText: "spread" }).waitFor();
    await settled(page, () => wire().boundingBox());
    const before = await text();
    const steps = observer.document?.undo ?? 0;
    await pick();
    await chip().waitFor();
    await drag(40);
    await observer.until(() => factor() === 3);
    expect(observer.document?.undo).toBe(steps + 1);
    await expect.poll(() => chip().textContent()).toBe("3");
    await panel(page, "Inspector").getByRole("button", { name: "spread", exact: true }).waitFor();
    expect(await number(page, "strength").inputValue()).toBe("3");
    await shot(page, `strength-${kind}`);
    await button(page, "Undo").click();
    await observer.until(() => factor() === undefined);
    expect(await text()).toBe(before);
    await type(page, "strength", "-2");
    await observer.until(() => factor() === -2);
    await type(page, "strength", "1");
    await observer.until(() => factor() === undefined);
    expect(await text()).toBe(before);
  });
}

test("connections that a folded group draws as one say that each has a strength of its own", async () => {
  const { page } = studio;
  const [{ source, target } = { source: "", target: "" }] = observer.document?.connections ?? [];
  const { made = [] } = await observer.ask({
    type: "add_element",
    kind: "Field",
    name: "other",
    at: [420, 200],
  });
  await observer.ask({ type: "connect", source, target: made[0] ?? "" });
  await observer.ask({ type: "group", elements: [target, made[0] ?? ""], name: "maps" });
  await observer.ask({ type: "arrange", layout: { folded: ["maps"] } });
  await page.locator(".graph-count").waitFor();
  await showEverything(page);
  await pick();
  const card = page.locator(".graph-wire-card");
  await card
    .getByText("2 connections, each with a strength of its own: open the group to change it.")
    .waitFor();
  await shot(page, "strength-several");
});
