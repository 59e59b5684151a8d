import { expect, onTestFinished, test } from "vitest";

import { ident, many } from "./bench/documents";
import { button, number, panel, type } from "./hands";
import { shot, startStudio } from "./studio";

const COUNT = 5000;
/** Longest time of each step, ours: other tests load the machine at the same time. */
const LONGEST_MS = 180_000;

test(
  "a document of 5,000 elements opens; one is found, edited, undone, removed and back",
  async () => {
    const { layout, ...rest } = many(COUNT) as { layout: { boxes: object } };
    const files = { "many.json": JSON.stringify({ ...rest, layout: { boxes: layout.boxes } }) };
    const { page, observe, stop } = await startStudio({ files });
    onTestFinished(stop);
    const observer = await observe();
    const timed = async (what: string, does: () => Promise<unknown>) => {
      const begun = performance.now();
      await does();
      const took = performance.now() - begun;
      console.log(`${what}: ${Math.round(took)} ms`);
      expect(took, what).toBeLessThan(LONGEST_MS);
    };
    await timed("opened", async () => {
      await observer.ask({ type: "open_file", path: "many.json" });
      await page.locator(".react-flow__node").first().waitFor();
    });
    await shot(page, "large");
    await timed("found", async () => {
      await page.keyboard.press("Control+k");
      await page.getByRole("dialog").getByRole("combobox").fill("u4321");
      await page.keyboard.press("Enter");
      await panel(page, "Inspector").getByRole("heading", { name: "u4321", exact: true }).waitFor();
    });
    await timed("edited", async () => {
      await type(page, "tau", "33");
      await observer.until(() => observer.value("u4321", "tau") === 33);
    });
    await timed("undone", async () => {
      await button(page, "Undo").click();
      await expect.poll(() => number(page, "tau").inputValue(), { timeout: LONGEST_MS }).toBe("20");
    });
    await timed("removed", async () => {
      await page.getByRole("group", { name: /^u4321, / }).focus();
      await page.keyboard.press("Delete");
      await page.getByRole("group", { name: /^u4321, / }).waitFor({ state: "detached" });
    });
    await timed("back", async () => {
      await page.keyboard.press("Control+z");
      await page.getByRole("group", { name: /^u4321, / }).waitFor();
      await page
        .locator(`.react-flow__edge[data-id*="${ident("u4321")}"]`)
        .first()
        .waitFor();
    });
    await shot(page, "large-found");
  },
  6 * LONGEST_MS,
);
