import { readFileSync } from "node:fs";
import { join } from "node:path";

import type { Locator, Page } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";

import { obstacles } from "./axe";
import { button, choose, panel, typed } from "./hands";
import { shot, startStudio, type Studio } from "./studio";
import { writeTwoTargets } from "./twoTargets";

let studio: Studio;

beforeAll(async () => {
  studio = await startStudio();
  await writeTwoTargets(studio.folder);
});

afterAll(() => studio.stop());

const shown = () => panel(studio.page, "Experiment");
const field = (name: string): Locator =>
  shown()
    .getByRole("textbox", { name, exact: true })
    .or(shown().getByRole("combobox", { name, exact: true }));
const status = (text: RegExp) => expect.poll(() => shown().getByRole("status").innerText()).toMatch(text);

async function open(name: string): Promise<void> {
  const { page } = studio;
  await page.keyboard.press("Control+o");
  const dialog = page.getByRole("dialog");
  await dialog.getByRole("button", { name, exact: true }).click();
  await dialog.waitFor({ state: "detached" });
}

/** Choose one of the names that a field lists. */
async function pick(box: Locator, name: string): Promise<void> {
  await box.click();
  await studio.page.getByRole("option", { name, exact: true }).last().click();
}

const written = (name: string): string => readFileSync(join(studio.folder, name), "utf8");

test("an experiment opens from the list of files, runs, and shows each condition", async () => {
  const { page } = studio;
  await open("two-targets.json");
  await shown().getByRole("region", { name: "Appears detected" }).waitFor();
  await status(/^100 trials$/);
  await shot(page, "experiment-design");
  await button(page, "Run the experiment").click();
  await status(/^100 of 100 trials, complete$/);
  const bars = shown().getByRole("figure", { name: "place in each condition" });
  expect(await bars.getByRole("img").count()).toBe(4);
  const near = bars.getByRole("img", {
    name: /^distance near, preshape 1: median 4\d(\.\d+)? of 25 trials$/,
  });
  await near.waitFor();
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "experiment-results");
});

test("a row opens the record of its trial, and the model comes back", async () => {
  const { page } = studio;
  await shown().getByRole("button", { name: "Replay trial 63" }).click();
  await page.getByRole("toolbar", { name: "Record" }).waitFor();
  await shown().getByText("Trial 63 is open as a record.").waitFor();
  const row = shown().getByRole("row", { selected: true });
  expect((await row.innerText()).split(/\s+/)[0]).toBe("63");
  await shot(page, "experiment-trial");
  await shown().getByRole("button", { name: "Back to the model" }).click();
  await page.getByRole("toolbar", { name: "Run", exact: true }).waitFor();
  await shown().getByRole("row", { selected: true }).waitFor({ state: "detached" });
});

/** Delay what the page sends from now on, as on a machine that is busy. */
async function delayed(page: Page): Promise<(ms: number) => void> {
  let [delay, last] = [0, Promise.resolve()];
  await page.routeWebSocket(/\/ws/, (socket) => {
    const server = socket.connectToServer();
    socket.onMessage((message) => {
      const wait = delay;
      last = last.then(async () => {
        if (wait > 0) await new Promise((done) => setTimeout(done, wait));
        server.send(message);
      });
    });
  });
  await page.reload();
  return (ms) => {
    delay = ms;
  };
}

test("an experiment is built with the mouse, and its file is the one that Python writes", async () => {
  const { page } = studio;
  const delay = await delayed(page);
  await choose(page, "More for the experiment", "New");
  await status(/^20 trials$/);
  await typed(field("limit"), "600");
  await typed(field("trials"), "25");

  await button(page, "Add to Factors").click();
  await typed(field("Name of factor"), "distance");
  await shown().getByRole("region", { name: "Factor distance" }).getByText("Named levels").click();
  await typed(field("Name of level 1 of distance"), "near");
  for (const path of ["left.center", "right.center", "preshape.center"])
    await pick(field("Add a parameter to distance"), path);
  await button(page, "Add a level to distance").click();
  const values = { left: ["46", "35"], right: ["54", "65"], preshape: ["46", "35"] };
  await field("left.center at level").waitFor();
  await typed(field("Name of level 2 of distance"), "far");
  await field("left.center at far").waitFor();
  delay(100);
  for (const [name, [near, far]] of Object.entries(values)) {
    await typed(field(`${name}.center at near`), near as string);
    await typed(field(`${name}.center at far`), far as string);
  }
  delay(0);
  await button(page, "Add to Factors").click();
  await typed(field("Name of factor"), "preshape");
  await pick(field("Parameter of preshape"), "preshape.amplitude");
  await typed(field("Level 1 of preshape"), "0");
  await button(page, "Add a level to preshape").click();
  expect(await field("Level 2 of preshape").inputValue()).toBe("1");

  await choose(page, "Add to Conditions", "Appears");
  await typed(field("Name of appears"), "detected");
  const card = shown().getByRole("region", { name: "Appears detected" });
  await card.getByText("an Appears needs 'field'", { exact: false }).waitFor();
  await status(/^cannot run yet$/);
  await card.scrollIntoViewIfNeeded();
  await shot(page, "experiment-problem");
  await pick(field("detected.field"), "u");
  await button(page, "Add to Measures").click();
  await typed(field("Name of measure"), "place");
  await pick(field("place.of"), "u.activation");
  await pick(field("place.reduce"), "place");
  await typed(field("place.threshold"), "-2.5");
  await status(/^100 trials$/);
  await button(page, "Undo in the experiment").click();
  await expect.poll(() => field("place.threshold").inputValue()).not.toBe("-2.5");
  await page.keyboard.press("Control+z");
  await expect.poll(() => field("place.reduce").inputValue()).not.toBe("place");
  await page.keyboard.press("Control+Shift+z");
  await button(page, "Redo in the experiment").click();
  await expect.poll(() => field("place.threshold").inputValue()).toBe("-2.5");
  await expect.poll(() => button(page, "Redo in the experiment").isDisabled()).toBe(true);
  expect(await button(page, "Undo").isDisabled(), "the document was not edited").toBe(true);
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "experiment-built");

  const dialog = page.getByRole("dialog");
  await choose(page, "More for the experiment", "Close");
  await dialog.getByText("The experiment two targets was edited since it was saved.").waitFor();
  await shot(page, "experiment-unsaved");
  await dialog.getByRole("button", { name: "Cancel" }).click();
  await dialog.waitFor({ state: "detached" });
  await button(page, "Save the experiment").click();
  await typed(dialog.getByRole("textbox", { name: "Name" }), "built");
  await expect.poll(() => button(page, "Save the experiment").isDisabled()).toBe(true);
  expect(await page.getByText("changed on another page").count()).toBe(0);
  expect(written("built.json")).toBe(written("two-targets.json"));
});

test("an action is added as a card, and the bars of each condition grow while the trials run", async () => {
  await open("two-targets.json");
  await shown().getByText("Design", { exact: true }).click();
  const { page } = studio;
  await typed(field("trials"), "500");
  await choose(page, "Add to Actions", "Push");
  const card = shown().getByRole("region", { name: "Push 1" });
  await typed(card.getByRole("textbox", { name: "0.at", exact: true }), "100");
  await pick(card.getByRole("combobox", { name: "0.element", exact: true }), "u");
  await typed(card.getByRole("textbox", { name: "0.amount", exact: true }), "-20");
  await typed(card.getByRole("textbox", { name: "0.lasting", exact: true }), "600");
  await status(/^2000 trials$/);
  await card.scrollIntoViewIfNeeded();
  await shot(page, "experiment-action");
  await button(page, "Run the experiment").click();
  await pick(shown().getByRole("combobox", { name: "Shown column" }), "duration");
  const bars = shown().getByRole("figure", { name: "duration in each condition" }).getByRole("img");
  const labels = () => bars.evaluateAll((all) => all.map((one) => one.getAttribute("aria-label") ?? ""));
  const counted = async () =>
    (await labels()).map((one) => Number(/ of (\d+) trials$/.exec(one)?.[1] ?? 0)).reduce((a, b) => a + b, 0);
  await shown().evaluate((panel) => {
    const counts = new Set<number>();
    const look = () => {
      const labels = [...panel.querySelectorAll(".experiment-bars [role=img]")].map((one) =>
        Number(/ of (\d+) trials$/.exec(one.getAttribute("aria-label") ?? "")?.[1] ?? 0),
      );
      if (document.querySelector("[aria-label='Stop the experiment']") !== null)
        counts.add(labels.reduce((a, b) => a + b, 0));
    };
    new MutationObserver(look).observe(panel, { subtree: true, attributes: true, childList: true });
    Object.assign(window, { counts });
  });
  await status(/^2000 of 2000 trials, complete$/);
  await shot(page, "experiment-bars");
  await expect.poll(counted).toBe(2000);
  const grown = await page.evaluate(() => [...(window as unknown as { counts: Set<number> }).counts]);
  expect(grown.length, "the rows come in pieces of 250 trials").toBeGreaterThan(2);
  expect([...grown].sort((a, b) => a - b)).toEqual(grown);
  // the push keeps the field below its threshold: every trial ends at the limit
  for (const one of await labels()) expect(one).toMatch(/: median 600 of 500 trials$/);
});

test("the panel fits a narrow window, in both colour schemes", async () => {
  const { page } = studio;
  await page.emulateMedia({ colorScheme: "dark" });
  await button(page, "Run the experiment").click();
  await status(/^2000 of 2000 trials, complete$/);
  await shot(page, "experiment-dark");
  await page.setViewportSize({ width: 640, height: 800 });
  await shot(page, "experiment-narrow-dark");
  await page.emulateMedia({ colorScheme: "light" });
  await shown().getByText("Design", { exact: true }).click();
  await shot(page, "experiment-narrow");
  const wide = await shown().evaluate((element) => element.scrollWidth - element.clientWidth);
  expect(wide).toBeLessThanOrEqual(0);
});
