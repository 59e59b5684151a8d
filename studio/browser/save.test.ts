import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { button, file, openExample, reopen, select, type } from "./hands";
import type { Observer } from "./observer";
import { startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({ copies: ["examples/node.json", "examples/selection.json"] });
  observer = await studio.observe();
});

// Each test opens the same file again.
beforeEach(async () => {
  writeFileSync(
    join(studio.folder, "node.json"),
    readFileSync(join(import.meta.dirname, "../../examples/node.json")),
  );
  await reopen(studio.page, observer, "node.json");
  await select(studio.page, "u");
});

afterAll(() => studio.stop());

async function edit(tau: number): Promise<void> {
  await type(studio.page, "tau", String(tau));
  await observer.until(() => observer.value("u", "tau") === tau);
  await studio.page.getByRole("img", { name: "Unsaved edits" }).waitFor();
}

const onDisk = (name: string) => readFileSync(join(studio.folder, name), "utf8");
const question = (title: string) => studio.page.getByRole("dialog", { name: title });

test("a dot in the title marks unsaved edits, until they are saved or undone", async () => {
  const { page } = studio;
  await expect.poll(() => page.title()).toBe("node – deodar studio");
  await edit(31);
  await expect.poll(() => page.title()).toBe("● node – deodar studio");
  await page.keyboard.press("Control+s");
  await page.getByText("Saved as node.json").first().waitFor();
  await expect.poll(() => page.title()).toBe("node – deodar studio");
  expect(onDisk("node.json")).toContain('"tau": 31');
  await edit(32);
  await button(page, "Undo").click();
  await expect.poll(() => page.title()).toBe("node – deodar studio");
});

test("save as asks for a name, refuses an invalid one, and warns of an existing file", async () => {
  const { page } = studio;
  await edit(41);
  await page.keyboard.press("Control+Shift+S");
  const dialog = question("Save as");
  const name = dialog.getByRole("textbox", { name: "Name" });
  const save = dialog.getByRole("button", { name: "Save", exact: true });
  expect(await name.inputValue()).toBe("node.json");
  await name.fill("a/b");
  await save.click();
  await dialog.getByText("A name without /").waitFor();
  await name.fill("selection");
  await dialog.getByText("A file of this name is there; you will be asked.").waitFor();
  await save.click();
  const replace = question("Overwrite the file?");
  await replace.getByText("selection.json is there already.").waitFor();
  await replace.getByRole("button", { name: "Save as…" }).click();
  await name.fill("copy");
  await save.click();
  await observer.until(() => observer.document?.file === "copy.json");
  expect(onDisk("copy.json")).toContain('"tau": 41');
  expect(onDisk("selection.json")).not.toContain('"tau": 41');
  expect(onDisk("node.json")).not.toContain('"tau": 41');
});

test("saving asks if the file changed on disk", async () => {
  const { page, folder } = studio;
  await edit(51);
  writeFileSync(join(folder, "node.json"), `${onDisk("node.json")}\n`);
  await page.keyboard.press("Control+s");
  const replace = question("Overwrite the file?");
  await replace.getByText("was changed on disk since it was opened or saved here.").waitFor();
  await replace.getByRole("button", { name: "Cancel" }).click();
  await replace.waitFor({ state: "detached" });
  expect(onDisk("node.json")).not.toContain('"tau": 51');
  await page.keyboard.press("Control+s");
  await replace.getByRole("button", { name: "Write over it" }).click();
  await observer.until(() => observer.document?.unsaved === false);
  expect(onDisk("node.json")).toContain('"tau": 51');
});

test("closing asks whether to cancel, discard or save unsaved edits", async () => {
  const { page } = studio;
  const dialog = question("Keep the unsaved edits?");
  const gallery = page.getByRole("heading", { name: "Examples" });

  await edit(61);
  await file(page, /^Close/);
  await dialog.getByRole("button", { name: "Cancel" }).click();
  await dialog.waitFor({ state: "detached" });
  expect(observer.document?.file).toBe("node.json");

  await file(page, /^Close/);
  await dialog.getByRole("button", { name: "Discard edits" }).click();
  await gallery.waitFor();
  expect(onDisk("node.json")).not.toContain('"tau": 61');

  await reopen(page, observer, "node.json");
  await select(page, "u");
  await edit(62);
  await file(page, /^Close/);
  await dialog.getByRole("button", { name: "Save", exact: true }).click();
  await gallery.waitFor();
  expect(onDisk("node.json")).toContain('"tau": 62');
});

test("closing an edited example asks for a name", async () => {
  const { page, folder } = studio;
  await file(page, /^Close/);
  await openExample(page, "Node");
  await observer.until(() => observer.document?.file === "");
  await select(page, "u");
  await edit(71);
  await file(page, /^Close/);
  await question("Keep the unsaved edits?").getByRole("button", { name: "Save", exact: true }).click();
  await question("Save as").getByRole("textbox", { name: "Name" }).fill("from example");
  await question("Save as").getByRole("button", { name: "Save", exact: true }).click();
  await page.getByRole("heading", { name: "Examples" }).waitFor();
  expect(existsSync(join(folder, "from example.json"))).toBe(true);
});

test("the browser asks before it leaves a page with unsaved edits", async () => {
  const { another } = studio;
  await edit(81);
  const page = await another();
  await page.getByRole("img", { name: "Unsaved edits" }).waitFor();
  await page.getByRole("tab", { name: "Sliders" }).click();
  const asked = page.waitForEvent("dialog");
  const left = page.close({ runBeforeUnload: true });
  const dialog = await asked;
  expect(dialog.type()).toBe("beforeunload");
  await dialog.dismiss();
  await left;
  expect(page.isClosed()).toBe(false);

  await observer.ask({ type: "save" });
  await page.getByRole("img", { name: "Unsaved edits" }).waitFor({ state: "detached" });
  await page.close({ runBeforeUnload: true });
  await expect.poll(() => page.isClosed()).toBe(true);
});
