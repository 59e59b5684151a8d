import { expect, onTestFinished, test } from "vitest";

import { obstacles } from "./axe";
import { box, button, drag, select, settled, slider } from "./hands";
import { shot, startStudio } from "./studio";

test("the tour is taken step by step, each by its own control", async () => {
  const { page, observe, stop } = await startStudio();
  onTestFinished(stop);
  await button(page, "Tour of five minutes").click();
  const tour = page.getByRole("complementary", { name: "Tour" });
  const next = async (title: string) => {
    await tour.getByLabel("Done.").waitFor();
    await tour.getByRole("button", { name: "Next" }).click();
    await tour.getByRole("heading", { name: title }).waitFor();
    expect(await tour.getByLabel("Done.").count()).toBe(0);
  };
  await tour.getByRole("heading", { name: "Run the model" }).waitFor();
  const observer = await observe();
  await observer.runs();
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "tour-first");
  await page.keyboard.press("Space");

  await next("Select an element");
  await select(page, "u");
  await next("Find an instability");
  await drag(page, slider(page, "resting_level"), 0.1);
  await shot(page, "tour-instability");
  await next("Undo");
  await page.keyboard.press("Control+z");

  await next("Add input by hand");
  const plot = page.getByRole("region", { name: "Curves of u" }).locator("canvas").first();
  const area = await plot.boundingBox();
  await page.mouse.move((area?.x ?? 0) + (area?.width ?? 0) / 2, (area?.y ?? 0) + (area?.height ?? 0) / 2);
  await page.mouse.down({ button: "right" });
  await tour.getByLabel("Done.").waitFor();
  await page.mouse.up({ button: "right" });

  await next("Go back in time");
  await page.getByRole("slider", { name: "Moment" }).focus();
  await page.keyboard.press("ArrowLeft");
  await next("Add an element");
  await page.getByRole("button", { name: "Live" }).click();
  await page.keyboard.press("/");
  await page.keyboard.type("gaussian stim");
  await page.keyboard.press("Enter");

  await next("Connect it");
  await button(page, "Show everything").click();
  const port = box(page, "gaussian_stimulus").locator(".react-flow__handle[data-handleid=output]");
  const [from, to] = await settled(page, () =>
    Promise.all([port.boundingBox(), box(page, "u").boundingBox()]),
  );
  if (from === null || to === null) throw new Error("The boxes are not visible.");
  await page.mouse.move(from.x + from.width / 2, from.y + from.height / 2);
  await page.mouse.down();
  await page.mouse.move(to.x + 40, to.y + 40, { steps: 8 });
  await page.mouse.up();
  await shot(page, "tour-connect");
  await next("Save");
  await page.keyboard.press("Control+s");
  await page.getByRole("textbox", { name: "Name" }).fill("mine");
  await page.getByRole("dialog").getByRole("button", { name: "Save", exact: true }).click();
  await tour.getByLabel("Done.").waitFor();
  await shot(page, "tour-last");
  await tour.getByRole("button", { name: "End", exact: true }).click();
  await tour.waitFor({ state: "detached" });
});

test("a step can be skipped, and the tour ended", async () => {
  const { page, stop } = await startStudio();
  onTestFinished(stop);
  await button(page, "Tour of five minutes").click();
  const tour = page.getByRole("complementary", { name: "Tour" });
  await tour.getByRole("button", { name: "Skip" }).click();
  await tour.getByRole("heading", { name: "Select an element" }).waitFor();
  await tour.getByRole("button", { name: "End the tour" }).click();
  await tour.waitFor({ state: "detached" });
});
