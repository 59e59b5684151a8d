import { afterAll, beforeAll, expect, test } from "vitest";

import { choose, panel, settled } from "./hands";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;

beforeAll(async () => {
  studio = await startStudio({ copies: ["examples/selection.json"], file: "selection.json" });
  await (await studio.observe()).runs();
});

afterAll(() => studio.stop());

const open = (title: string) => choose(studio.page, "Open panels and plots", title);

async function close(title: string): Promise<void> {
  const tab = studio.page.getByRole("tab", { name: title, exact: true });
  await tab.locator(".dv-default-tab-action").click();
  await panel(studio.page, title).waitFor({ state: "detached" });
}

/** The panels with their places on the page. */
const places = () =>
  studio.page
    .getByRole("tabpanel")
    .evaluateAll((panels) =>
      panels.map((one) => [one.getAttribute("aria-label"), JSON.stringify(one.getBoundingClientRect())]),
    );

test("panels that are opened and closed again leave the others where they were, to the pixel", async () => {
  await panel(studio.page, "Inspector").waitFor();
  const before = await places();
  expect(before).toHaveLength(4);
  for (const title of ["Costs", "World"]) {
    await open(title);
    await panel(studio.page, title).waitFor();
    expect(await places(), title).not.toEqual(before);
    await close(title);
    await expect.poll(places, { message: title }).toEqual(before);
  }
  await open("Costs");
  await open("World");
  await close("Costs");
  await studio.page.getByRole("tab", { name: "World", exact: true }).press("Delete");
  await panel(studio.page, "World").waitFor({ state: "detached" });
  await expect.poll(places).toEqual(before);
  await shot(studio.page, "panels-restored");
});

test("a border that was moved meanwhile stays where it is", async () => {
  const before = await places();
  await open("Costs");
  await panel(studio.page, "Costs").waitFor();
  const inspector = await settled(studio.page, () => panel(studio.page, "Inspector").boundingBox());
  if (inspector === null) throw new Error("The inspector is not visible.");
  const { mouse } = studio.page;
  await mouse.move(inspector.x - 1, inspector.y + 100);
  await mouse.down();
  await mouse.move(inspector.x - 81, inspector.y + 100, { steps: 4 });
  await mouse.up();
  const width = async () => (await panel(studio.page, "Inspector").boundingBox())?.width ?? 0;
  await expect.poll(width).toBeGreaterThan(inspector.width + 60);
  await close("Costs");
  await expect.poll(width).toBeGreaterThan(inspector.width + 60);
  expect(await places()).not.toEqual(before);
});
