import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import type { Locator } from "playwright-core";
import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { obstacles } from "./axe";
import { box, button, file, openEmpty, panel, select, showEverything, type } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio();
  await studio.context.grantPermissions(["clipboard-read", "clipboard-write"]);
  observer = await studio.observe();
});

// A stimulus that is connected with a field, and a second stimulus.
beforeEach(async () => {
  const { page } = studio;
  await openEmpty(page, observer);
  await observer.ask({ type: "add_element", kind: "GaussianStimulus", name: "a", at: [0, 0] });
  const [source = ""] = observer.document?.elements.map(({ id }) => id) ?? [];
  await observer.ask({
    type: "add_element",
    kind: "Field",
    name: "u",
    at: [260, 40],
    source: { element: source },
  });
  await observer.ask({ type: "add_element", kind: "GaussianStimulus", name: "b", at: [20, 200] });
  await observer.until(() => observer.document?.elements.length === 3);
  await box(page, "b").waitFor();
  await showEverything(page);
  await page.locator(".react-flow__pane").click({ position: { x: 300, y: 20 } });
});

afterAll(() => studio.stop());

const paths = (): string =>
  (observer.document?.elements ?? [])
    .map(({ path }) => path)
    .sort()
    .join();
const at = (path: string): { x: number; y: number } | undefined =>
  (observer.document?.layout["boxes"] as Record<string, { x: number; y: number }>)[observer.element(path).id];

async function placeOf(locator: Locator): Promise<{ x: number; y: number; width: number; height: number }> {
  const found = await locator.boundingBox();
  if (found === null) throw new Error("It is not visible.");
  return found;
}

test("what is selected is copied, pasted, cut and duplicated, with its connections", async () => {
  const { page } = studio;
  await page.keyboard.press("Control+a");
  await page.keyboard.press("Control+c");
  await expect
    .poll(() => page.evaluate(() => navigator.clipboard.readText()))
    .toContain('"GaussianStimulus"');
  await page.keyboard.press("Control+v");
  await observer.until(() => paths() === "a,a2,b,b2,u,u2");
  expect(observer.document?.connections.length).toBe(2);
  await page.keyboard.press("Control+z");
  await observer.until(() => paths() === "a,b,u");
  await box(page, "b2").waitFor({ state: "detached" });
  await showEverything(page); // the view had moved to the copies
  await select(page, "b");
  await page.keyboard.press("Control+d");
  await observer.until(() => paths() === "a,b,b2,u");
  const [one, other] = [await placeOf(box(page, "b")), await placeOf(box(page, "b2"))];
  const apart = one.y + one.height < other.y || one.x + one.width < other.x || other.x + other.width < one.x;
  expect(apart, "the copy lies over nothing").toBe(true);
  await select(page, "a");
  await page.keyboard.press("Control+x");
  await observer.until(() => paths() === "b,b2,u");
  await page.keyboard.press("Control+v");
  await observer.until(() => paths() === "a,b,b2,u");
});

test("a paste right after a copy waits for its text, however late the server answers", async () => {
  const { page } = studio;
  await page.keyboard.press("Escape");
  await page.evaluate(() => navigator.clipboard.writeText("an older text"));
  await page.evaluate(() => {
    const send = WebSocket.prototype.send;
    WebSocket.prototype.send = function (this: WebSocket, data: string) {
      if (data.includes('"type":"copy"')) setTimeout(() => send.call(this, data), 1500);
      else send.call(this, data);
    };
  });
  const before = paths();
  await select(page, "u");
  await page.keyboard.press("Control+c");
  await page.keyboard.press("Control+v");
  await observer.until(() => paths() === `${before},u2`);
  await page.keyboard.press("Control+z");
  await observer.until(() => paths() === before);
  await page.reload();
  await box(page, "u").waitFor();
});

test("a copy goes to another window as text, and foreign text is refused as a whole", async () => {
  const { page, another } = studio;
  await select(page, "u");
  await page.keyboard.press("Control+c");
  await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).toContain('"Field"');
  const text = await page.evaluate(() => navigator.clipboard.readText());
  expect(Object.keys((JSON.parse(text) as { elements: object }).elements)).toEqual(["u"]);
  const second = await another();
  await box(second, "u").waitFor();
  await second.locator(".react-flow__pane").click({ position: { x: 300, y: 20 } });
  await second.keyboard.press("Control+v");
  await observer.until(() => paths() === "a,b,u,u2");
  const state = () => JSON.stringify([paths(), observer.document?.connections, observer.document?.undo]);
  const before = state();
  for (const [foreign, said] of [
    ["no document", /the clipboard holds no elements/i],
    [text.slice(0, text.length / 2), /the clipboard holds no elements/i],
    [text.replace('"Field"', '"Nothing"'), /Nothing/],
  ] as const) {
    await second.evaluate((content) => navigator.clipboard.writeText(content), foreign);
    await second.keyboard.press("Control+v");
    await second.getByText(said).first().waitFor();
    expect(state(), foreign).toBe(before);
  }
  await second.close();
});

test("a pasted function is not imported: the page opens without it, or states how to trust it", async () => {
  const { page, folder } = studio;
  writeFileSync(join(folder, "hostile.py"), 'open("called", "w").close()\n');
  const called = { kind: "Function", id: "0000000a", axes: [], function: "hostile:call" };
  const text = JSON.stringify({ deodar: 1, name: "hostile", elements: { f: called }, connections: [] });
  await page.evaluate((content) => navigator.clipboard.writeText(content), text);
  await page.keyboard.press("Control+v");
  await observer.until(() => paths() === "a,b,f,u");
  await page.getByText("The file names functions of its own, which can run any code.").waitFor();
  await button(page, "How to trust it").click();
  await page.getByText(/deodar studio .* --trust/).waitFor();
  await shot(page, "edit-hostile");
  expect(existsSync(join(folder, "called"))).toBe(false);
  await page.keyboard.press("Escape");
  await button(page, "Open without them").click();
  await observer.until(() => paths() === "a,b,u");
  await button(page, "Undo").click();
  await observer.until(() => paths() === "a,b,f,u");
  await button(page, "Undo").click();
  await observer.until(() => paths() === "a,b,u");
  await observer.runs();
});

test("elements are grouped, the group is renamed, and dissolved", async () => {
  const { page } = studio;
  await select(page, "a");
  await box(page, "b").click({ position: { x: 20, y: 12 }, modifiers: ["Shift"] });
  await page.keyboard.press("Control+g");
  await observer.until(() => paths() === "group.a,group.b,u");
  await page.locator(".graph-frame[data-selected]").waitFor();
  await page.keyboard.press("F2");
  await page.getByRole("textbox", { name: "New name of group" }).fill("inputs");
  await shot(page, "edit-rename");
  await page.keyboard.press("Enter");
  await observer.until(() => paths() === "inputs.a,inputs.b,u");
  await page.locator(".graph-frame[data-selected]").getByText("inputs").waitFor();
  await page.keyboard.press("Shift+g");
  await observer.until(() => paths() === "a,b,u");
});

/**
 * Hold a box or the title of a group, and drag it to a place of the screen, where it waits to be released; it
 * rests for `ms` on the way.
 */
async function dragTo(
  from: { x: number; y: number },
  to: { x: number; y: number },
  marked: Locator,
  ms = 0,
): Promise<void> {
  const { page } = studio;
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move((from.x + to.x) / 2, (from.y + to.y) / 2, { steps: 3 });
  await page.waitForTimeout(ms);
  await page.mouse.move(to.x, to.y, { steps: 3 });
  await marked.waitFor();
}

const head = async (path: string) => {
  const { x, y } = await placeOf(box(studio.page, path));
  return { x: x + 20, y: y + 12 };
};

test("a box is dragged into an open group and out of it, each as one step of undo", async () => {
  const { page } = studio;
  await observer.ask({ type: "group", elements: [observer.element("u").id], name: "g" });
  const frame = page.locator(".graph-frame");
  await frame.waitFor();
  await showEverything(page);
  const before = at("b");
  const { x, y, width, height } = await placeOf(frame);
  await dragTo(await head("b"), { x: x + 12, y: y + height - 12 }, page.locator(".graph-frame[data-into]"));
  await shot(page, "edit-drag-into");
  await page.mouse.up();
  await observer.until(() => paths() === "a,g.b,g.u");
  await page.locator(".graph-frame[data-into]").waitFor({ state: "detached" });
  expect(at("g.b"), "it stays where it was released").not.toEqual(before);
  await box(page, "g.b").waitFor();
  await page.keyboard.press("Control+z");
  await observer.until(() => paths() === "a,b,g.u");
  expect(at("b")).toEqual(before);
  await page.keyboard.press("Control+Shift+z");
  await observer.until(() => paths() === "a,g.b,g.u");
  await box(page, "g.b").waitFor();
  await showEverything(page);

  const wide = await placeOf(frame);
  const out = { x: wide.x + wide.width + 30, y: wide.y + wide.height / 2 };
  await dragTo(await head("g.b"), out, page.locator(".graph[data-into]"));
  await shot(page, "edit-drag-out");
  await page.mouse.up();
  await observer.until(() => paths() === "a,b,g.u");
  expect(width).toBeLessThan(wide.width + 1);
});

test("a box and a group are dragged onto a folded group, and lie in it when it is opened", async () => {
  const { page } = studio;
  const ids = (names: string[]) => names.map((name) => observer.element(name).id);
  await observer.ask({ type: "group", elements: ids(["u"]), name: "g" });
  await observer.ask({ type: "group", elements: ids(["b"]), name: "h" });
  await observer.ask({ type: "arrange", layout: { folded: ["g"] }, undoable: false });
  const folded = page.getByRole("group", { name: /^Group g, folded/ });
  await folded.waitFor();
  await showEverything(page);
  const over = async () => {
    const { x, y, width, height } = await placeOf(folded);
    return { x: x + width / 2, y: y + height / 2 };
  };
  const taken = page.locator(".graph-folded[data-into]");
  await dragTo(await head("a"), await over(), taken);
  await shot(page, "edit-drag-folded");
  await page.mouse.up();
  await observer.until(() => paths() === "g.a,g.u,h.b");
  await box(page, "a").waitFor({ state: "detached" });
  await showEverything(page);
  const title = await placeOf(page.locator(".graph-frame-title"));
  const grip = { x: title.x + title.width - 8, y: title.y + title.height / 2 };
  await dragTo(grip, await over(), taken, 600); // no part of it becomes a change of its own
  await page.mouse.up();
  await observer.until(() => paths() === "g.a,g.h.b,g.u");
  await button(page, "Unfold g").click();
  await box(page, "g.h.b").waitFor();
  await shot(page, "edit-drag-opened");
  const [one, other] = [await placeOf(box(page, "g.a")), await placeOf(box(page, "g.u"))];
  expect(one.y, "below the box that was there").toBeGreaterThanOrEqual(other.y + other.height);
  await page.keyboard.press("Control+z");
  await observer.until(() => paths() === "g.a,g.u,h.b");
  await page.keyboard.press("Control+z");
  await observer.until(() => paths() === "a,g.u,h.b");
});

test("F2 renames an element in its place, and a name that is taken is refused", async () => {
  const { page } = studio;
  await select(page, "a");
  await page.keyboard.press("F2");
  const field = page.getByRole("textbox", { name: "New name of a" });
  await field.fill("left");
  await field.press("Enter");
  await observer.until(() => paths() === "b,left,u");
  await select(page, "left");
  await page.keyboard.press("F2");
  await page.getByRole("textbox", { name: "New name of left" }).fill("b");
  await page.keyboard.press("Enter");
  await page
    .getByRole("alert")
    .or(page.getByText(/already/))
    .first()
    .waitFor();
  expect(paths()).toBe("b,left,u");
});

test("a problem has a button that removes it, as one step of undo", async () => {
  const { page } = studio;
  await select(page, "u");
  await type(page, "resting_level", "5");
  const banner = panel(page, "Inspector").getByRole("alert");
  const repair = banner.getByRole("button", { name: "Change the sign" });
  await repair.waitFor();
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "repair");
  await repair.click();
  await observer.until(() => observer.value("u", "resting_level") === -5);
  await repair.waitFor({ state: "detached" });
  await page.keyboard.press("Control+z");
  await observer.until(() => observer.value("u", "resting_level") === 5);
  await page.getByRole("button", { name: /^\d+ warnings?$/ }).click();
  const list = page.getByRole("list", { name: /^\d+ warnings?$/ });
  await list.getByRole("button", { name: "Change the sign" }).first().waitFor();
  expect(await obstacles(page)).toEqual([]);
});

test("a box that is dragged with Alt is copied to there", async () => {
  const { page } = studio;
  await select(page, "b");
  const before = at("b");
  const { x, y } = await placeOf(box(page, "b"));
  await page.keyboard.down("Alt");
  await page.mouse.move(x + 30, y + 12);
  await page.mouse.down();
  await page.mouse.move(x + 150, y + 60, { steps: 6 });
  await page.mouse.up();
  await page.keyboard.up("Alt");
  await observer.until(() => paths() === "a,b,b2,u");
  expect(at("b")).toEqual(before);
  expect(at("b2")?.x).toBeGreaterThan((before?.x ?? 0) + 50);
});

test("a frame drawn with Shift selects boxes, and commands align them", async () => {
  const { page } = studio;
  const [a, b] = [await placeOf(box(page, "a")), await placeOf(box(page, "b"))];
  await page.keyboard.down("Shift");
  await page.mouse.move(a.x - 12, a.y - 12);
  await page.mouse.down();
  await page.mouse.move(b.x + b.width + 6, b.y + b.height + 6, { steps: 6 });
  await shot(page, "edit-marquee");
  await page.mouse.up();
  await page.keyboard.up("Shift");
  await panel(page, "Inspector").getByText("2 elements").first().waitFor();
  await page.keyboard.press("Control+k");
  const commands = page.getByRole("dialog", { name: "Commands and elements" });
  await commands.getByRole("combobox").fill("align left");
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "edit-commands");
  await page.keyboard.press("Enter");
  await observer.until(() => at("b")?.x === at("a")?.x);
  expect(at("b")?.y).toBe(200);
});

test("three boxes are distributed with equal gaps, downwards and to the right", async () => {
  const { page } = studio;
  await page.keyboard.press("Control+a");
  await panel(page, "Inspector").getByText("3 elements").first().waitFor();
  const gaps = async (start: "x" | "y", size: "width" | "height") => {
    const all = await Promise.all(["a", "b", "u"].map((path) => placeOf(box(page, path))));
    const [one, two, three] = all.sort((p, q) => p[start] - q[start]);
    if (one === undefined || two === undefined || three === undefined) return Number.NaN;
    return Math.abs(two[start] - one[start] - one[size] - (three[start] - two[start] - two[size]));
  };
  for (const [command, start, size] of [
    ["distribute vertically", "y", "height"],
    ["distribute horizontally", "x", "width"],
  ] as const) {
    expect(await gaps(start, size), "before").toBeGreaterThan(5);
    await page.keyboard.press("Control+k");
    await page.getByRole("dialog", { name: "Commands and elements" }).getByRole("combobox").fill(command);
    await page.keyboard.press("Enter");
    await expect.poll(() => gaps(start, size)).toBeLessThan(3);
  }
});

test("the commands and the menu of files export the document as a Python script", async () => {
  const { page } = studio;
  await page.keyboard.press("Control+k");
  const commands = page.getByRole("dialog", { name: "Commands and elements" });
  await commands.getByRole("combobox").fill("python");
  const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Enter")]);
  expect(download.suggestedFilename()).toBe("untitled.py");
  expect(readFileSync(await download.path(), "utf8")).toContain('dd.GaussianStimulus("a", [x]');
  await Promise.all([page.waitForEvent("download"), file(page, "Export as Python script")]);
});

test("Ctrl+K goes to an element; a right click on a box lists what can be done with it", async () => {
  const { page } = studio;
  await page.keyboard.press("Control+k");
  const commands = page.getByRole("dialog", { name: "Commands and elements" });
  await commands.getByRole("combobox").fill("u field");
  await commands.getByRole("option", { name: /^u\b/ }).click();
  await panel(page, "Inspector").getByRole("heading", { name: "u", exact: true }).waitFor();
  await box(page, "b").click({ button: "right", position: { x: 20, y: 12 } });
  const list = page.getByRole("dialog", { name: "Commands for the selection" });
  await list.getByRole("option", { name: /^Duplicate/ }).click();
  await observer.until(() => paths() === "a,b,b2,u");
});

test("the inspector changes a parameter of several elements together, as one step of undo", async () => {
  const { page } = studio;
  await select(page, "a");
  await box(page, "b").click({ position: { x: 20, y: 12 }, modifiers: ["Shift"] });
  await panel(page, "Inspector").getByRole("heading", { name: "2 elements" }).waitFor();
  await type(page, "amplitude", "7.5");
  await observer.until(
    () => observer.value("a", "amplitude") === 7.5 && observer.value("b", "amplitude") === 7.5,
  );
  await shot(page, "edit-many");
  await page.locator(".react-flow__pane").click({ position: { x: 300, y: 20 } });
  await page.keyboard.press("Control+z");
  await observer.until(
    () => observer.value("a", "amplitude") === 6 && observer.value("b", "amplitude") === 6,
  );
});

test("a comment is written, moved and removed, and undo brings it back", async () => {
  const { page } = studio;
  const comments = () =>
    Object.values(
      (observer.document?.layout["comments"] ?? {}) as Record<string, { text: string; x: number }>,
    );
  await page.mouse.move(640, 520); // beside the boxes, which lie above comments
  await page.keyboard.press("Shift+c");
  const field = page.getByRole("textbox", { name: "Text of the comment" });
  await field.fill("Inputs compete here.");
  await page.locator(".react-flow__pane").click({ position: { x: 300, y: 20 } });
  await observer.until(() => comments()[0]?.text === "Inputs compete here.");
  const comment = page.locator(".graph-comment");
  await shot(page, "edit-comment");
  const before = comments()[0]?.x ?? 0;
  const { x, y } = await placeOf(comment);
  await page.mouse.move(x + 20, y + 50);
  await page.mouse.down();
  await page.mouse.move(x + 80, y + 70, { steps: 5 });
  await page.mouse.up();
  await observer.until(() => (comments()[0]?.x ?? 0) > before + 20);
  await comment.hover();
  await button(page, "Remove the comment").click();
  await comment.waitFor({ state: "detached" });
  await page.locator(".react-flow__pane").click({ position: { x: 300, y: 20 } });
  await page.keyboard.press("Control+z");
  await comment.getByText("Inputs compete here.").waitFor();
});
