import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";

import { afterAll, beforeAll, expect, test } from "vitest";

import { button, choose } from "./hands";
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

test("what is plotted is recorded while the model runs, and the record opens", async () => {
  const { page } = studio;
  await button(page, "Play").click();
  await observer.until(() => observer.running);
  await button(page, "Record").click();
  await observer.until(() => observer.clock?.recording?.ended === "");
  const path = observer.clock?.recording?.path ?? "";
  const begun = observer.time;
  await observer.until(() => observer.time > begun + 300);
  await shot(page, "recording");
  await button(page, "Stop recording").click();
  await observer.until(() => observer.clock?.recording?.ended === "closed");
  expect(observer.running, "the run continues").toBe(true);
  const folder = join(studio.folder, path);
  expect(readdirSync(folder).sort()).toEqual(["model.json", "record.zarr"]);
  const group = JSON.parse(readFileSync(join(folder, "record.zarr", "zarr.json"), "utf8"));
  const arrays = group.consolidated_metadata.metadata;
  expect(arrays["u.activation"].shape[0]).toBeGreaterThan(200);
  expect(JSON.parse(group.attributes.deodar).complete).toBe(true);
  await page.getByRole("region", { name: "Messages" }).getByText(`Recorded into ${path}`).waitFor();
  await button(page, "Open the record").click();
  await button(page, "Run its model").waitFor();
  await page.getByRole("region", { name: /of u$/ }).locator("canvas").first().waitFor();
  await choose(page, "Menu of this plot", "Save as a figure file");
  await page
    .getByRole("region", { name: "Messages" })
    .getByText("Saved as selection-figure-001.toml")
    .waitFor();
  const figure = readFileSync(join(studio.folder, "selection-figure-001.toml"), "utf8");
  expect(figure).toContain(`record = "${path}"`);
  expect(figure).toContain('variable = "u.activation"');
});
