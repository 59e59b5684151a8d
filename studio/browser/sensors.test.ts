import { writeFileSync } from "node:fs";
import { join } from "node:path";

import { afterAll, beforeAll, expect, test } from "vitest";

import { button, drop, openExample, png } from "./hands";
import type { Observer } from "./observer";
import { startStudio, type Studio } from "./studio";

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  studio = await startStudio();
  observer = await studio.observe();
  await openExample(studio.page, "Saliency");
  await observer.runs();
  await button(studio.page, "Play").click();
  await observer.until(() => observer.time > 0);
});

afterAll(() => studio.stop());

/** The largest value of a channel of the picture that the sensor reads. */
const channel = (n: number) =>
  Math.max(...observer.values("eye", "output").filter((_, index) => index % 3 === n));

test("a picture that is dropped on the page is what the sensor reads, and the run continues", async () => {
  const before = observer.time;
  await drop(studio.page, "red.png", "image/png", png(40, 40, [255, 0, 0]));
  await observer.until(() => observer.clock?.world === "Picture: red.png");
  await observer.until(() => channel(0) === 1 && channel(1) === 0 && channel(2) === 0);
  expect(observer.running).toBe(true);
  expect(observer.time).toBeGreaterThanOrEqual(before);
});

test("a picture below the folder can be chosen in the header", async () => {
  writeFileSync(join(studio.folder, "blue.png"), png(40, 40, [0, 0, 255]));
  await button(studio.page, "The sensors read Picture: red.png; choose another picture").click();
  await studio.page.getByRole("dialog").getByRole("button", { name: "blue.png" }).click();
  await observer.until(() => observer.clock?.world === "Picture: blue.png");
});
