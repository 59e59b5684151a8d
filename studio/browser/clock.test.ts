import { afterAll, beforeAll, expect, test } from "vitest";

import { obstacles } from "./axe";
import { beside, button, choose, openTool, panel } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({ copies: ["examples/selection.json"], file: "selection.json" });
  observer = await studio.observe();
  await observer.runs();
});

afterAll(() => studio.stop());

test("a run that cannot keep up shows its lag; a longest step is accepted or refused", async () => {
  const { page } = studio;
  const factor = page.getByLabel("Speed measured");
  await expect.poll(() => factor.innerText()).toMatch(/real time/);
  await observer.ask({ type: "speed", factor: 1e6 });
  await button(page, "Play").click();
  await observer.until(() => (observer.clock?.overruns ?? 0) > 0 && (observer.clock?.lost ?? 0) > 1000);
  await expect.poll(() => factor.innerText()).toMatch(/\d+ ms late/);
  await factor.hover();
  const told = page.getByRole("tooltip");
  await expect
    .poll(() => told.innerText())
    .toMatch(/steps in a second\s+Behind by \d+ ms, at most \d+ ms since it was played\s+Fell behind once/);
  await expect.poll(() => told.innerText()).toMatch(/were skipped/);
  await shot(page, "late");

  await beside(page, "Run settings", async (settings) => {
    const longest = settings.getByRole("textbox", { name: "Longest step, where time is short" });
    await longest.fill("4");
    await longest.press("Enter");
    await longest.fill("100");
    await observer.until(() => observer.clock?.longest === 4 && observer.clock.dt === 4);
    expect(await longest.inputValue(), "the answer does not replace later input").toContain("100");
    await longest.press("Enter");
    await settings.getByRole("alert").getByText("longer than the time constant").waitFor();
    expect(observer.clock?.longest).toBe(4);
    await longest.fill("");
    await longest.press("Enter");
    await observer.until(() => observer.clock?.longest === null && observer.clock.dt === 1);
  });
  await observer.ask({ type: "speed", factor: 1 });
  await button(page, "Pause").click();
  await observer.until(() => !observer.running);
  await expect.poll(() => factor.innerText()).toMatch(/real time/);
  expect(await factor.locator("[data-late]").count()).toBe(0);
});

test("the cost of each element is measured while the model runs, and a row selects its element", async () => {
  const { page } = studio;
  await choose(page, "Open panels and plots", "Costs");
  const costs = panel(page, "Costs");
  await costs.getByText("How long each element takes in a step").waitFor();
  await button(page, "Play").click();
  await observer.until(() => observer.running);
  await costs.getByRole("button", { name: "Measure costs" }).click();
  const table = costs.getByRole("table", { name: "Time that each element takes of a step" });
  await table.waitFor();
  expect(observer.running).toBe(true);
  await costs
    .getByRole("status")
    .getByText(/A step takes [\d.]+ µs/)
    .waitFor();
  const rows = await table.getByRole("row").allInnerTexts();
  expect(rows).toHaveLength(4);
  expect(rows[1]).toMatch(/^u\s+Field\s+[\d.]+\s+[\d.]+ %/);
  await table.getByRole("button", { name: "left", exact: true }).click();
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "costs");
  await openTool(page, "Inspector");
  await panel(page, "Inspector").getByRole("heading", { name: "left", exact: true }).waitFor();
  await openTool(page, "Costs");
  await costs.getByRole("button", { name: "Measure costs" }).click();
  await costs.getByRole("button", { name: "Measure costs again" }).waitFor();
});
