import { expect, onTestFinished, test } from "vitest";

import { obstacles } from "./axe";
import { button, choose, panel } from "./hands";
import { shot, startStudio } from "./studio";

test("a field is tuned to a regime with the mouse, and the values are one step back", async () => {
  const { page, stop, observe } = await startStudio({
    copies: ["examples/selection.json"],
    file: "selection.json",
  });
  onTestFinished(stop);
  const observer = await observe();
  await observer.runs();
  await choose(page, "Open panels and plots", "Regime");
  const tune = panel(page, "Regime").getByRole("region", { name: "Tune to a regime" });
  const begin = tune.getByRole("button", { name: "Tune", exact: true });
  const detection = tune.getByRole("checkbox", { name: "detection threshold" });
  await detection.click();
  await tune.getByText("Choose what the field is to do.").waitFor();
  expect(await begin.isDisabled()).toBe(true);
  await detection.click();
  await tune.getByRole("textbox", { name: "detection threshold, value" }).fill("4");
  await tune.getByRole("combobox", { name: "after its input a peak" }).selectOption("remembers");
  await tune.getByRole("combobox", { name: "two equal inputs" }).selectOption("selects");
  expect(await tune.getByRole("checkbox", { name: "kernel.0.sigma" }).isChecked()).toBe(true);
  await tune.getByRole("checkbox", { name: "kernel.0.sigma" }).click();
  await begin.click();
  await tune.getByRole("button", { name: "Stop tuning" }).waitFor();

  await tune
    .getByText(/^All requirements are met; all parameters may change by [\d.]+ % at once\./)
    .waitFor();
  const met = tune.getByRole("list", { name: "Requirements" }).getByRole("listitem");
  expect(await met.allInnerTexts()).toEqual([
    expect.stringMatching(/^The detection threshold is (3\.[89]\d*|4|4\.[01]\d*); you asked for 4 ± 0\.2\.$/),
    "As you asked, a peak stays after its input.",
    "As you asked, two equal inputs end in one peak.",
  ]);
  await tune.getByRole("button", { name: "Try again" }).click();
  await tune.getByRole("button", { name: "Stop tuning" }).waitFor();
  await tune.getByText(/^All requirements are met/).waitFor();
  const values = tune.getByRole("table", { name: "Values found" });
  await values.getByRole("row", { name: /^u\.resting_level -5 → -?[\d.]+$/ }).waitFor();
  expect(await values.getByRole("row").count()).toBe(3);
  const apply = tune.getByRole("button", { name: "Keep", exact: true });
  await apply.scrollIntoViewIfNeeded();
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "tuning");

  const before = observer.value("u", "kernel.0.amplitude");
  await apply.click();
  await tune.getByRole("button", { name: "The field has these values" }).waitFor();
  await observer.until(() => observer.value("u", "kernel.0.amplitude") !== before);
  expect(observer.value("u", "kernel.0.sigma")).toBe(5);
  await button(page, "Undo").click();
  await apply.waitFor();
  await observer.until(() => observer.value("u", "kernel.0.amplitude") === before);
  expect(observer.value("u", "resting_level")).toBe(-5);
});
