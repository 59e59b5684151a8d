import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { afterAll, beforeAll, expect, onTestFinished, test } from "vitest";

import { obstacles } from "./axe";
import { button, drop, file, number, openExample, select, type } from "./hands";
import type { Observer } from "./observer";
import { runPython } from "./server";
import { shot, startStudio, type Studio } from "./studio";

const SELECTION = join(import.meta.dirname, "../../examples/selection.json");

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({ copies: ["examples/selection.json", "examples/node.json"] });
  mkdirSync(join(studio.folder, "models"));
  writeFileSync(join(studio.folder, "models", "deep.json"), readFileSync(join(studio.folder, "node.json")));
  observer = await studio.observe();
});

afterAll(() => studio.stop());

const title = () => studio.page.getByRole("banner").getByRole("heading", { level: 1 });

test("the gallery has a picture and a sentence for each example", async () => {
  const { page } = studio;
  const cards = page.getByRole("region", { name: "Examples" }).getByRole("button");
  await cards.first().waitFor();
  expect(await cards.count()).toBeGreaterThanOrEqual(12);
  for (const card of await cards.all()) {
    const picture = card.locator("img");
    await picture.scrollIntoViewIfNeeded();
    await expect
      .poll(() => picture.evaluate((image) => (image as HTMLImageElement).naturalWidth))
      .toBeGreaterThan(100);
    expect(await card.innerText()).toMatch(/^[A-Z].*\n+[A-Z].+\.$/);
  }
  await shot(page, "gallery");
});

test("a file is found by its name, through the folders", async () => {
  const { page } = studio;
  await button(page, "Open a file").click();
  const dialog = page.getByRole("dialog", { name: "Open a file" });
  const content = dialog.getByRole("list", { name: "Content of the folder" });
  await content.getByRole("button", { name: "selection.json" }).waitFor();
  await content.getByRole("button", { name: "models" }).click();
  await content.getByRole("button", { name: "deep.json" }).waitFor();
  await dialog
    .getByRole("navigation", { name: "Folder" })
    .getByRole("button", { name: "folder", exact: true })
    .click();
  await content.getByRole("button", { name: "node.json" }).waitFor();
  await content.getByRole("button", { name: "models" }).click();
  await content.getByRole("button", { name: "deep.json" }).click();
  await dialog.waitFor({ state: "detached" });
  await observer.until(() => observer.document?.file === "models/deep.json");
  await page.getByRole("banner").getByText("models/deep.json").waitFor();
});

test("recent files are offered", async () => {
  const { page } = studio;
  await file(page, /^Close/);
  await page.getByRole("list", { name: "Recent files" }).getByRole("button", { name: "deep.json" }).click();
  await page.getByRole("banner").getByText("models/deep.json").waitFor();
  await page.keyboard.press("Control+o");
  const dialog = page.getByRole("dialog", { name: "Open a file" });
  await dialog.getByRole("button", { name: "deep.json" }).waitFor();
  await page.keyboard.press("Escape");
  await dialog.waitFor({ state: "detached" });
});

test("a dropped document is opened, after a question if there are unsaved edits", async () => {
  const { page } = studio;
  await select(page, "u");
  await type(page, "tau", "33");
  await observer.until(() => observer.document?.unsaved && observer.value("u", "tau") === 33);
  const dialog = page.getByRole("dialog", { name: "Keep the unsaved edits?" });

  await drop(page, "selection.json", "application/json", readFileSync(SELECTION));
  await dialog.getByRole("button", { name: "Cancel" }).click();
  await dialog.waitFor({ state: "detached" });
  expect(await title().innerText()).toBe("node");
  expect(await number(page, "tau").inputValue()).toBe("33");

  await drop(page, "selection.json", "application/json", readFileSync(SELECTION));
  await dialog.getByRole("button", { name: "Discard edits" }).click();
  await observer.until(() => observer.document?.title === "selection");
  expect(observer.document?.file, "what was dropped is content, no file").toBe("");
  await page.getByRole("banner").getByText("not in a file yet").waitFor();
});

test("a dropped package is opened", async () => {
  const { page, folder } = studio;
  await runPython(["-m", "deodar", "pack", "example:binding", "--out", "packed.deodar"], folder);
  await drop(page, "packed.deodar", "", readFileSync(join(folder, "packed.deodar")));
  await observer.until(() => observer.document?.title === "binding" && observer.document.file === "");
  await expect.poll(() => title().innerText(), { message: "the page has it too" }).toBe("binding");
});

test("an invalid document is refused with a reason", async () => {
  const { page } = studio;
  await drop(page, "notes.txt", "text/plain", new TextEncoder().encode("hello"));
  const message = page
    .getByRole("region", { name: "Messages" })
    .getByText("notes.txt is neither a document (.json, .deodar) nor a file that a world opens.");
  await message.waitFor();
  await button(page, "Dismiss").click();
  await message.waitFor({ state: "detached" });
});

test("a dropped file of 200 MB is refused by the page, and so is a long text in the clipboard", async () => {
  const { page } = studio;
  await observer.ask({ type: "open_example", name: "selection", discard: true });
  await button(page, "Play").waitFor();
  await page.evaluate(() => {
    const carried = new DataTransfer();
    carried.items.add(new File([new Uint8Array(200 * 2 ** 20)], "large.json"));
    document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: carried, bubbles: true }));
  });
  const messages = page.getByRole("region", { name: "Messages" });
  await messages.getByText("large.json is larger than 40 MB.").waitFor();
  await page.evaluate(() => {
    const text = new DataTransfer();
    text.setData("text/plain", " {".repeat(21 * 2 ** 20));
    document.dispatchEvent(new ClipboardEvent("paste", { clipboardData: text, bubbles: true }));
  });
  await messages.getByText("The text in the clipboard is larger than 40 MB.").waitFor();
  expect((await observer.ask({ type: "export_script" })).text).toContain("dd.Model");
});

test("a file with errors opens as a page that lists every problem with its path", async () => {
  const { page, folder } = studio;
  const data = JSON.parse(readFileSync(SELECTION, "utf8")) as {
    elements: Record<string, Record<string, unknown>>;
  };
  Object.assign(data.elements["u"] ?? {}, { tau: -1 });
  Object.assign(data.elements["left"] ?? {}, { kind: "GausianStimulus" });
  writeFileSync(join(folder, "bad.json"), JSON.stringify(data));
  await file(page, /^Open…/);
  await page.getByRole("dialog").getByRole("button", { name: "bad.json" }).click();
  await page.getByRole("heading", { name: "bad.json cannot be opened" }).waitFor();
  const problems = page.getByRole("list", { name: "Problems" }).getByRole("listitem");
  expect(await problems.count()).toBe(2);
  const said = (await problems.allInnerTexts()).join("\n");
  expect(said).toContain("u.tau");
  expect(said).toMatch(/^left$/m);
  expect(said).toContain("GaussianStimulus");
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "problems");

  await button(page, "Back to the gallery").click();
  await openExample(page, "Node");
  await file(page, "Examples");
  await button(page, "Back to node").click();
  await title().waitFor();
});

test("a file on the command line is opened; if it is deleted, saving writes it again", async () => {
  const second = await startStudio({ copies: ["examples/node.json"], file: "node.json" });
  onTestFinished(second.stop);
  const { page, folder } = second;
  await page.getByRole("heading", { name: "node", level: 1 }).waitFor();
  await page.getByRole("banner").getByText("node.json").waitFor();
  rmSync(join(folder, "node.json"));
  await select(page, "u");
  await type(page, "tau", "44");
  await page.getByRole("img", { name: "Unsaved edits" }).waitFor();
  await page.keyboard.press("Control+s");
  await page.getByText("Saved as node.json").waitFor();
  await page.getByRole("img", { name: "Unsaved edits" }).waitFor({ state: "detached" });
  expect(existsSync(join(folder, "node.json"))).toBe(true);
  expect(readFileSync(join(folder, "node.json"), "utf8")).toContain('"tau": 44');
});
