import { expect, onTestFinished, test } from "vitest";

import { obstacles } from "./axe";
import { button, choose, colours, number, openTool, panel, select } from "./hands";
import { shot, startStudio } from "./studio";

test("the regime of a field is measured, drawn and stale after a change of the field", async () => {
  const { page, stop, observe } = await startStudio({
    copies: ["examples/selection.json"],
    file: "selection.json",
  });
  onTestFinished(stop);
  const observer = await observe();
  await observer.runs();
  await button(page, "Play").click();
  await observer.until(() => observer.running);
  await choose(page, "Open panels and plots", "Regime");
  const regime = panel(page, "Regime");
  await regime.getByText("What the field does alone").waitFor();
  expect(
    await regime.getByRole("combobox", { name: "Field or node" }).locator("option").allInnerTexts(),
  ).toEqual(["u"]);

  await regime.getByRole("button", { name: "Measure regime" }).click();
  await regime.getByRole("button", { name: "Stop" }).waitFor();
  await regime.getByRole("button", { name: "Measure regime again" }).waitFor();
  const words = regime.getByRole("status").getByText(/selective/);
  await words.waitFor();
  const table = regime.getByRole("table", { name: "Measurements" });
  await table.getByRole("row", { name: /^detection threshold [\d.]+ ± [\d.]+/ }).waitFor();
  const curve = regime.getByRole("img", { name: /^Settled activation: .*selective/ });
  await expect.poll(() => colours(curve)).toBeGreaterThan(5);
  expect(observer.running, "the run continues").toBe(true);
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "regime");

  expect(await regime.getByText("has changed since").count()).toBe(0);
  await select(page, "u");
  const level = number(page, "resting_level");
  await level.fill("-9");
  await level.press("Enter");
  await openTool(page, "Regime");
  await regime.getByText("The field has changed since").waitFor();
  const before = await table.innerText();
  await regime.getByRole("button", { name: "Measure regime again" }).click();
  // at once: it may end while the button is still moving
  await regime.getByRole("button", { name: "Stop" }).dispatchEvent("click");
  await regime.getByText("What the field does alone").waitFor();
  await regime.getByRole("button", { name: "Measure regime" }).click();
  await table.waitFor();
  expect(await table.innerText()).not.toBe(before);
});
