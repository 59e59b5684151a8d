import { readFileSync } from "node:fs";
import { join } from "node:path";

import { expect, onTestFinished, test } from "vitest";

import {
  box,
  button,
  colours,
  drag,
  drawn,
  file,
  number,
  openExample,
  panel,
  select,
  slider,
  type,
} from "./hands";
import { shot, startStudio } from "./studio";

test("a new user makes a peak, lets it decay and return, saves the file and opens it again", async () => {
  const { page, folder, observe, stop } = await startStudio();
  onTestFinished(stop);
  await openExample(page, "Selection");
  const observer = await observe();
  await observer.runs();

  const plot = page.getByRole("region", { name: "Curves of u" });
  await plot.waitFor();
  const before = await drawn(plot.locator("canvas").first());
  await button(page, "Play").click();
  await observer.until(() => observer.max("u", "activation") > 3);
  await button(page, "Pause").waitFor();
  await plot.getByText("Press play").waitFor({ state: "detached" });
  await expect.poll(() => drawn(plot.locator("canvas").first())).not.toBe(before);
  expect(await colours(plot.locator("canvas").first())).toBeGreaterThan(5);
  await expect
    .poll(() => colours(page.getByRole("img", { name: "activation of u, live" })))
    .toBeGreaterThan(2);
  await shot(page, "newcomer-peak");

  await select(page, "u");
  await drag(page, slider(page, "resting_level"), 0);
  await observer.until(() => observer.value("u", "resting_level") === -10);
  await observer.until(() => observer.max("u", "activation") < 0);
  await expect.poll(() => number(page, "resting_level").inputValue()).toBe("-10");
  expect(await page.title()).toMatch(/^● /);

  await page.keyboard.press("Control+z");
  await observer.until(() => observer.value("u", "resting_level") === -5);
  await observer.until(() => observer.max("u", "activation") > 3);
  await expect.poll(() => number(page, "resting_level").inputValue()).toBe("-5");

  await type(page, "tau", "25");
  await observer.until(() => observer.value("u", "tau") === 25);
  const frame = await box(page, "u").boundingBox();
  await page.mouse.move((frame?.x ?? 0) + 60, (frame?.y ?? 0) + 12);
  await page.mouse.down();
  await page.mouse.move((frame?.x ?? 0) + 60, (frame?.y ?? 0) + 62, { steps: 5 });
  await page.mouse.up();
  const boxes = () => observer.document?.layout.boxes ?? {};
  await observer.until(() => boxes()[observer.element("u").id] !== undefined);
  const dragged = boxes();

  await file(page, /^Save as/);
  await page.getByRole("textbox", { name: "Name" }).fill("mine");
  await page.getByRole("dialog").getByRole("button", { name: "Save", exact: true }).click();
  await page.getByText("Saved as mine.json").waitFor();
  await expect.poll(() => page.title()).toBe("selection – deodar studio");
  const kept = JSON.parse(readFileSync(join(folder, "mine.json"), "utf8")) as {
    elements: Record<string, { tau: number }>;
    layout: { boxes: unknown };
  };
  expect(kept.elements["u"]?.tau).toBe(25);
  expect(kept.layout.boxes).toEqual(dragged);

  await file(page, /^Close/);
  await page
    .getByRole("list", { name: "Recent files" })
    .getByRole("button", { name: /mine\.json/ })
    .click();
  await observer.until(() => observer.document?.file === "mine.json");
  await box(page, "u").waitFor();
  expect(observer.value("u", "tau")).toBe(25);
  expect(boxes()).toEqual(dragged);
  await select(page, "u");
  expect(await number(page, "tau").inputValue()).toBe("25");
  await expect
    .poll(() =>
      panel(page, "Inspector").getByRole("textbox", { name: "resting_level", exact: true }).inputValue(),
    )
    .toBe("-5");
});
