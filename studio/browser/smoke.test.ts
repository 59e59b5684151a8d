import { expect, onTestFinished, test } from "vitest";

import { shot, startStudio } from "./studio";

test("the page opens and draws something", async () => {
  const { page, stop } = await startStudio();
  onTestFinished(stop);
  expect(await page.title()).toContain("deodar");
  await page.waitForFunction(() => (document.getElementById("root")?.innerText ?? "").trim() !== "");
  await shot(page, "smoke");
});

test("the browser has WebGL, in software", async () => {
  const { page, stop } = await startStudio();
  onTestFinished(stop);
  expect(await page.evaluate(() => document.createElement("canvas").getContext("webgl2") !== null)).toBe(
    true,
  );
});
