import { appendFileSync, cpSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import type { Locator } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";

import { obstacles } from "./axe";
import { button, choose, panel } from "./hands";
import { shot, startStudio, type Studio } from "./studio";
import { writeTwoTargets } from "./twoTargets";

let studio: Studio;

beforeAll(async () => {
  studio = await startStudio();
  await writeTwoTargets(studio.folder);
});

afterAll(() => studio.stop());

const shown = () => panel(studio.page, "Experiment");
const box = (name: string): Locator => shown().getByRole("textbox", { name, exact: true });
const standing = () => shown().getByRole("list", { name: "Standing of the experiment" });
const status = (text: RegExp) => expect.poll(() => shown().getByRole("status").innerText()).toMatch(text);

async function open(path: string[]): Promise<void> {
  const { page } = studio;
  await page.keyboard.press("Control+o");
  const dialog = page.getByRole("dialog");
  for (const name of path) await dialog.getByRole("button", { name, exact: true }).click();
  await dialog.waitFor({ state: "detached" });
}

test("the place of a run is chosen, and what is wrong with it is said in the panel", async () => {
  const { page } = studio;
  await open(["two-targets.json"]);
  await status(/^100 trials$/);
  await shown()
    .getByText(/^Where: \d+ process(es)?$/)
    .click();
  await box("Processes").waitFor();
  await shown().getByText("A cluster", { exact: true }).click();
  expect(await button(page, "Run the experiment").isDisabled(), "no address is stated").toBe(true);
  await box("Address").fill("tcp://10.0.0.5:8786");
  await button(page, "Run the experiment").click();
  await shown().getByText("tcp://10.0.0.5:8786 leads beyond this machine, without encryption").waitFor();
  await shown()
    .getByText(/that you trust it: .*the box Trust the network/)
    .waitFor();
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "cluster-refused");
  await page.emulateMedia({ colorScheme: "dark" });
  await shot(page, "cluster-refused-dark");
  await page.emulateMedia({ colorScheme: "light" });
  await box("Address").fill("local:2");
  await shown().getByText("leads beyond this machine").waitFor({ state: "detached" });
});

test("a run on a cluster shows its workers, and what --follow prints", async () => {
  const { page } = studio;
  await button(page, "Run the experiment").click();
  await standing().getByText("Waiting for the workers of local:2").waitFor();
  await standing()
    .getByText(/^2 workers of local:2, \d pieces? in flight$/)
    .waitFor();
  await status(/^100 of 100 trials, complete$/);
  expect(await standing().count()).toBe(0);
  const bars = shown().getByRole("figure", { name: "place in each condition" });
  await bars.getByRole("img", { name: /^distance near, preshape 1: .* of 25 trials$/ }).waitFor();
});

test("results that another process writes are followed to their end", async () => {
  const { page, folder } = studio;
  const [ours, theirs] = [join(folder, "two_targets-001"), join(folder, "theirs")];
  cpSync(ours, theirs, { recursive: true });
  const rows = join(theirs, "trials.jsonl");
  const lines = readFileSync(rows, "utf8").split(/(?<=\n)/);
  writeFileSync(rows, lines.slice(0, 21).join(""));
  await open(["Folder theirs", "experiment.json"]);
  await status(/^20 of 100 trials, stopped$/);
  appendFileSync(rows, lines.slice(21, 61).join(""));
  await status(/^60 of 100 trials \(60 %\), \d+ s left$/);
  await standing()
    .getByText("Another process runs this experiment. Its rows are read every second.")
    .waitFor();
  await standing()
    .getByText(/^Slowest: distance (near|far), preshape [01], median [\d.]+$/)
    .waitFor();
  expect(await button(page, "Run the experiment").isDisabled()).toBe(true);
  expect(await shown().getByRole("button", { name: "Replay trial 0" }).isDisabled()).toBe(true);
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "cluster-followed");
  await page.emulateMedia({ colorScheme: "dark" });
  await shot(page, "cluster-followed-dark");
  appendFileSync(rows, lines.slice(61).join(""));
  await status(/^100 of 100 trials, complete$/);
  await standing().waitFor({ state: "detached" });
  await choose(page, "More for the experiment", "Close");
});
