import { cpSync } from "node:fs";
import { join } from "node:path";

import { afterAll, beforeAll, expect, test } from "vitest";

import { obstacles } from "./axe";
import { button, drawn } from "./hands";
import { runPython } from "./server";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;

beforeAll(async () => {
  studio = await startStudio({ copies: ["examples/selection.json"] });
  const run = (out: string, ...words: string[]) =>
    runPython(
      ["-m", "deodar", "run", "selection.json", "--no-progress", "--duration", "400", "--out", out]
        .concat(["--record", "u.activation", "u.output", "--every", "2"])
        .concat(words),
      studio.folder,
      { DEODAR_STATE: studio.state },
    );
  await run("one");
  await run("other", "--set", "left.amplitude=3");
  cpSync(join(studio.folder, "one"), join(studio.folder, "same"), { recursive: true });
});

afterAll(() => studio.stop());

const bar = () => studio.page.getByRole("region", { name: "Comparison of records" });
const half = (name: string) => studio.page.getByRole("region", { name: `Record ${name}` });
const moment = () => studio.page.getByRole("status", { name: "Moment shown" });

async function choose(name: string): Promise<void> {
  const dialog = studio.page.getByRole("dialog");
  await dialog.getByRole("button", { name, exact: false }).click();
  await dialog.waitFor({ state: "detached" });
}

test("a record is shown beside the open one, with the first difference of each port", async () => {
  const { page } = studio;
  await page.keyboard.press("Control+o");
  await choose("one");
  await button(page, "Compare").click();
  await page.getByRole("dialog", { name: "Compare with another record" }).waitFor();
  await choose("other");
  await bar().getByText("Compared with other").waitFor();
  const activation = bar().getByRole("button", { name: /^u\.activation first differs at 10\d ms: / });
  await activation.waitFor();
  await activation.click();
  await expect.poll(() => moment().innerText()).toMatch(/^10\d ms/);
  await page.keyboard.press("End");
  await expect.poll(() => moment().innerText()).toMatch(/^400 ms/);
  const plots = () =>
    Promise.all(["one", "other"].map((name) => drawn(half(name).locator("canvas").first())));
  await expect.poll(async () => new Set(await plots()).size).toBe(2);
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "compare");
});

test("equal records have no difference, and their plots are the same", async () => {
  const { page } = studio;
  await button(page, "Compare").click();
  await choose("same");
  await bar().getByText("No difference in 2 ports.").waitFor();
  const plots = () => Promise.all(["one", "same"].map((name) => drawn(half(name).locator("canvas").first())));
  await expect.poll(async () => new Set(await plots()).size).toBe(1);
  await button(page, "End the comparison").click();
  await bar().waitFor({ state: "detached" });
  expect(await half("one").count()).toBe(0);
});
