import { expect, onTestFinished, test } from "vitest";

import { openExample } from "./hands";
import { shot, startStudio } from "./studio";

test("the page opens and draws something", async () => {
  const { page, stop } = await startStudio();
  onTestFinished(stop);
  expect(await page.title()).toContain("deodar");
  await page.waitForFunction(() => (document.getElementById("root")?.innerText ?? "").trim() !== "");
  await shot(page, "smoke");
});

test("the page opens where the language of the browser is none, as under the locale C", async () => {
  const { context, another, stop } = await startStudio();
  onTestFinished(stop);
  await context.addInitScript(() =>
    Object.defineProperty(navigator, "language", { value: "C", configurable: true }),
  );
  const page = await another();
  await page.getByRole("heading", { name: "Examples" }).waitFor();
  await openExample(page, "Selection");
  await page.getByRole("region", { name: "Curves of u" }).locator("canvas").first().waitFor();
});

test("the browser has WebGL, in software", async () => {
  const { page, stop } = await startStudio();
  onTestFinished(stop);
  expect(await page.evaluate(() => document.createElement("canvas").getContext("webgl2") !== null)).toBe(
    true,
  );
});
