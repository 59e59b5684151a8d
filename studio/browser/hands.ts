/** Actions of a user on the page, by the names of its controls. */
import { crc32, deflateSync } from "node:zlib";

import type { Download, Locator, Page } from "playwright-core";

import type { Observer } from "./observer";

/** A tool of the dock, or a part of the page beside it, by its title. */
export const panel = (page: Page, title: string): Locator => {
  const name = { name: title, exact: true };
  return page.getByRole("tabpanel", name).or(page.getByRole("region", name)).first();
};

/** Show a tool of the dock, where it is not shown. */
export async function openTool(page: Page, title: string): Promise<void> {
  if (!(await panel(page, title).isVisible())) await choose(page, "Open panels and plots", title);
  await panel(page, title).waitFor();
}

/** Show another view of the document. */
export async function showView(page: Page, view: "Build" | "Run" | "Experiment" | "Robot"): Promise<void> {
  await page.getByRole("radiogroup", { name: "View" }).getByText(view, { exact: true }).click();
}

/** The box of an element on the canvas. */
export const box = (page: Page, path: string): Locator =>
  page.getByRole("group", { name: new RegExp(`^${escaped(path)}, `) });

/** The slider of a parameter in the inspector, or of a pin by its path in another panel. */
export const slider = (page: Page, path: string, where = "Inspector"): Locator =>
  panel(page, where).getByRole("slider", { name: path, exact: true });

/** The number beside the slider. */
export const number = (page: Page, path: string, where = "Inspector"): Locator =>
  panel(page, where).getByRole("textbox", { name: path, exact: true });

export const button = (page: Page, name: string): Locator => page.getByRole("button", { name, exact: true });

/** Open an example from the gallery. */
export async function openExample(page: Page, title: string): Promise<void> {
  await page.getByRole("button", { name: new RegExp(`^${title} `) }).click();
  await page.getByRole("toolbar", { name: "Run" }).waitFor();
}

/**
 * Open a file again by way of the gallery, without confirmation, so that nothing on the page is of the
 * document before.
 */
export async function reopen(page: Page, observer: Observer, path: string): Promise<void> {
  await observer.ask({ type: "close", discard: true });
  await page.getByRole("heading", { name: "Examples" }).waitFor();
  await observer.ask({ type: "open_file", path });
  await observer.until(() => observer.document?.file === path);
  await observer.runs();
  await page.getByRole("toolbar", { name: "Run" }).waitFor();
}

/** Open an empty document, and wait until its canvas has replaced the one before. */
export async function openEmpty(page: Page, observer: Observer): Promise<void> {
  const pane = page.locator(".react-flow__pane");
  if ((await pane.count()) > 0) await pane.evaluate((old) => old.setAttribute("data-old", ""));
  await observer.ask({ type: "new", discard: true });
  await page.locator(".react-flow__pane:not([data-old])").waitFor();
  await page.getByText("This document has no elements yet.").waitFor();
}

/** Select an element on the canvas, so that the inspector shows it. */
export async function select(page: Page, path: string): Promise<void> {
  await box(page, path).click({ position: { x: 20, y: 12 } });
  await openTool(page, "Inspector");
  await panel(page, "Inspector")
    .getByRole("heading", { name: path.split(".").at(-1) as string, exact: true })
    .waitFor();
}

/** Type a number into its field and confirm it with Enter. */
export async function type(page: Page, path: string, text: string, where?: string): Promise<void> {
  const field = number(page, path, where);
  await field.fill(text);
  await field.press("Enter");
}

/** Choose an entry of the menu of a button. */
export async function choose(page: Page, name: string, item: string | RegExp): Promise<void> {
  await button(page, name).click();
  await page.getByRole("menuitem", { name: item, exact: typeof item === "string" }).click();
  await page.getByRole("menu").waitFor({ state: "detached" });
}

/** What is downloaded when something is done. */
export async function downloaded(page: Page, act: () => Promise<unknown>): Promise<Download> {
  // both at once: a download that never comes is an error of this call, whichever ends first
  const [download] = await Promise.all([page.waitForEvent("download"), act()]);
  return download;
}

/** Open the area beside a button, use it and close it. */
export async function beside(
  page: Page,
  name: string,
  use: (opened: Locator) => Promise<unknown>,
): Promise<void> {
  await button(page, name).click();
  const opened = page.getByRole("dialog");
  await use(opened);
  await page.keyboard.press("Escape");
  await opened.waitFor({ state: "detached" });
}

/** Type into a field, and take it with Enter. */
export async function typed(field: Locator, text: string): Promise<void> {
  await field.fill(text);
  await field.press("Enter");
}

/** Choose an entry of the menu of files. */
export const file = (page: Page, item: string | RegExp): Promise<void> => choose(page, "File menu", item);

/**
 * Measure the layout until two results agree: the inspector grows above its sliders while equations and
 * their fonts are loaded.
 */
export async function settled<T>(page: Page, measure: () => Promise<T>): Promise<T> {
  let before: T;
  let now = await measure();
  do {
    before = now;
    await page.waitForTimeout(200);
    now = await measure();
  } while (JSON.stringify(before) !== JSON.stringify(now));
  return now;
}

/** Show the whole canvas, and wait until its view no longer moves. */
export async function showEverything(page: Page): Promise<void> {
  await button(page, "Show everything").click();
  await settled(page, () => page.locator(".react-flow__viewport").getAttribute("style"));
}

/** Drag a slider to a position, a share of its length, and release it. */
export async function drag(page: Page, thumb: Locator, share: number): Promise<void> {
  const track = thumb.locator("xpath=ancestor::*[contains(@class, 'Slider-trackContainer')]");
  const [from, along] = await settled(page, () => Promise.all([thumb.boundingBox(), track.boundingBox()]));
  if (from === null || along === null) throw new Error("The slider is not visible.");
  await page.mouse.move(from.x + from.width / 2, from.y + from.height / 2);
  await page.mouse.down();
  await page.mouse.move(along.x + along.width * share, along.y + along.height / 2, { steps: 8 });
  await page.mouse.up();
}

/** The number of different colours on a canvas; an empty canvas has one. */
export function colours(canvas: Locator): Promise<number> {
  return canvas.evaluate((element) => {
    const found = (
      element instanceof HTMLCanvasElement ? element : element.querySelector("canvas")
    ) as HTMLCanvasElement;
    const { width, height } = found;
    const data = found.getContext("2d")?.getImageData(0, 0, width, height).data ?? new Uint8ClampedArray();
    return new Set(new Uint32Array(data.buffer)).size;
  });
}

/** The content of a canvas, to compare with a later one. */
export const drawn = (canvas: Locator): Promise<string> =>
  canvas.evaluate((element) => (element as HTMLCanvasElement).toDataURL());

/** Drop a file of the user's own on the page. */
export async function drop(page: Page, name: string, type: string, content: Uint8Array): Promise<void> {
  const carried = await page.evaluateHandle(
    ([bytes, called, sort]) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([new Uint8Array(bytes)], called, { type: sort }));
      return transfer;
    },
    [[...content], name, type] as const,
  );
  for (const event of ["dragenter", "dragover", "drop"])
    await page.dispatchEvent("body", event, { dataTransfer: carried });
}

function escaped(text: string): string {
  return text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
}

/** A PNG file of one colour (red, green and blue, 0 to 255). */
export function png(width: number, height: number, colour: readonly number[]): Uint8Array {
  const rows = Buffer.alloc(height * (1 + 3 * width));
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x++) rows.set(colour, y * (1 + 3 * width) + 1 + 3 * x);
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, 2], 8); // 8 bits each of red, green and blue
  const piece = (name: string, data: Uint8Array) => {
    const named = Buffer.concat([Buffer.from(name), data]);
    const out = Buffer.alloc(named.length + 8);
    out.writeUInt32BE(data.length, 0);
    out.set(named, 4);
    out.writeUInt32BE(crc32(named), named.length + 4);
    return out;
  };
  const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  return Buffer.concat([
    signature,
    piece("IHDR", head),
    piece("IDAT", deflateSync(rows)),
    piece("IEND", new Uint8Array()),
  ]);
}

/** A point of the canvas, in shares of its width and height. */
export async function place(page: Page, across: number, down: number): Promise<{ x: number; y: number }> {
  const all = await page.locator(".react-flow__pane").boundingBox();
  if (all === null) throw new Error("The canvas is not visible.");
  return { x: all.x + all.width * across, y: all.y + all.height * down };
}

/** Drag from the output of an element, and hold. */
export async function pull(page: Page, path: string, to: { x: number; y: number }): Promise<void> {
  const port = await box(page, path).locator(".react-flow__handle[data-handleid=output]").boundingBox();
  if (port === null) throw new Error(`The output of ${path} is not visible.`);
  await page.mouse.move(port.x + port.width / 2, port.y + port.height / 2);
  await page.mouse.down();
  await page.mouse.move(to.x, to.y, { steps: 8 });
}

/** A line of the palette that is open. */
export const option = (page: Page, name: string): Locator =>
  page.getByRole("dialog").getByRole("option", { name, exact: true });
