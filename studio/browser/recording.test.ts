import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";

import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";

import { beside, button, choose, reopen } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio({
    copies: ["examples/selection.json", "examples/saliency.json"],
    file: "selection.json",
  });
  observer = await studio.observe();
  await observer.runs();
});

afterAll(() => studio.stop());

beforeEach(() => reopen(studio.page, observer, "selection.json"));

/** The arrays of a record with their shapes, and its attributes. */
function recorded(path: string): { shapes: Record<string, number[]>; about: Record<string, unknown> } {
  const group = JSON.parse(readFileSync(join(studio.folder, path, "record.zarr", "zarr.json"), "utf8"));
  const arrays = Object.entries<{ shape: number[] }>(group.consolidated_metadata.metadata);
  return {
    shapes: Object.fromEntries(arrays.map(([name, { shape }]) => [name, shape])),
    about: JSON.parse(group.attributes.deodar),
  };
}

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
  const { shapes, about } = recorded(path);
  for (const port of ["activation", "output"]) expect(shapes[`u.${port}`]?.[0]).toBeGreaterThan(200);
  expect(about["complete"]).toBe(true);
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

test("the ports that are ticked beside the button are recorded, at the interval typed there", async () => {
  const { page } = studio;
  await beside(page, "What to record", async (menu) => {
    const tick = (name: string) => menu.getByRole("checkbox", { name, exact: true });
    for (const port of ["u.activation", "u.output"])
      expect(await tick(port).isChecked(), `${port} is plotted`).toBe(true);
    expect(await tick("left.output").isChecked(), "it is not plotted").toBe(false);
    for (const port of ["u.activation", "u.output"]) await tick(port).uncheck();
    await menu.getByText("None is ticked: the activation of every field is recorded.").waitFor();
    await tick("left.output").check();
    await menu.getByLabel("Sampling interval").fill("10");
    expect(await menu.getByLabel("Find a port to record").count(), "six ports need no search").toBe(0);
    await tick("u.input").check();
    await menu.getByText("2 ports").waitFor();
    await shot(page, "recording-choice");
  });
  await button(page, "Record").click();
  await observer.until(() => observer.clock?.recording?.ended === "");
  const path = observer.clock?.recording?.path ?? "";
  await expect.poll(() => button(page, "What to record").isDisabled()).toBe(true);
  await observer.ask({ type: "step", n: 100 });
  await observer.until(() => observer.clock?.tick === 100);
  await button(page, "Stop recording").click();
  await observer.until(() => observer.clock?.recording?.ended === "closed");
  const { shapes } = recorded(path);
  expect(shapes).toMatchObject({ "left.output": [11, 101], "u.input": [11, 101] });
  expect(Object.keys(shapes)).not.toContain("u.activation");

  await beside(page, "What to record", async (menu) => {
    await menu.getByRole("button", { name: "Tick what is plotted" }).click();
    expect(await menu.getByRole("checkbox", { name: "u.activation", exact: true }).isChecked()).toBe(true);
    expect(await menu.getByRole("checkbox", { name: "left.output", exact: true }).isChecked()).toBe(false);
  });
});

test("ports to record are found by a search, and another document has a choice of its own", async () => {
  const { page } = studio;
  await beside(page, "What to record", (menu) =>
    menu.getByRole("checkbox", { name: "left.output", exact: true }).check(),
  );
  await reopen(page, observer, "saliency.json");
  await beside(page, "What to record", async (menu) => {
    const ticked = menu.getByRole("checkbox", { checked: true });
    expect(await ticked.evaluateAll((all) => all.map((one) => one.closest("div")?.textContent))).toHaveLength(
      1,
    );
    await menu.getByLabel("Find a port to record").fill("perceptual.inp");
    await expect.poll(() => menu.getByRole("checkbox").count()).toBe(1);
    await menu.getByRole("checkbox", { name: "perceptual.input", exact: true }).check();
    await menu.getByText("2 ports").waitFor();
  });
});
