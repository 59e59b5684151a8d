import { readFileSync } from "node:fs";
import { join } from "node:path";

import { expect, onTestFinished, test } from "vitest";

import { button } from "./hands";
import { openPast } from "./past";
import { shot, startStudio } from "./studio";

test("a command that fails in the engine changes nothing, and the notice says what happened", async () => {
  const module = readFileSync(join(import.meta.dirname, "python", "failing.py"), "utf8");
  const { page, stop, observe } = await startStudio({
    copies: ["examples/selection.json"],
    files: { "failing.py": module },
    file: "selection.json",
    imports: ["failing"],
  });
  onTestFinished(stop);
  const observer = await observe();
  await observer.runs();
  await openPast(observer, 10);
  await button(page, "First frame").click();
  const moment = page.getByRole("status", { name: "Moment shown" });
  await expect.poll(() => moment.innerText()).toMatch(/^0 ms/);
  const document = JSON.stringify(observer.document);
  await button(page, "Run from here").click();
  await page.getByText("Run from here failed. The run is as it was at 0.010 s.").waitFor();
  await shot(page, "fault-notice");
  expect(observer.clock?.tick).toBe(10);
  expect(observer.running).toBe(false);
  expect(JSON.stringify(observer.document)).toBe(document);
  await button(page, "Copy the report").waitFor();
  await button(page, "Details").click();
  await page.getByText("the states are lost").waitFor();
  await button(page, "Run from here").click();
  await observer.until(() => observer.running);
});
