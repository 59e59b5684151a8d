/** What a person does about a problem with a mouse. */
import { afterAll, beforeAll, expect, test } from "vitest";

import { obstacles } from "./axe";
import { box, panel, reopen, select } from "./hands";
import type { Observer } from "./observer";
import { shot, startStudio, type Studio } from "./studio";

const axes = {
  x: { name: "x", lower: 0, upper: 100, samples: 101 },
  half: { name: "x", lower: 0, upper: 50, samples: 51 },
};
const field = { kind: "Field", noise: 0.1, axes: ["x"] };
const left = { kind: "GaussianStimulus", id: "00000001", axes: ["x"], center: 20, amplitude: 8 };
const LOOSE = { deodar: 2, name: "loose", axes, elements: { left, u: { ...field, id: "00000002" } } };
const APART = {
  ...LOOSE,
  name: "apart",
  elements: { left, v: { ...field, id: "00000002", axes: ["half"] } },
  connections: [{ source: "left", target: "v" }],
};
const EYE = {
  deodar: 2,
  name: "eye",
  dt: 64,
  axes,
  elements: { eye: { kind: "Sensor", id: "00000001", axes: ["x"], sensor: "sonar" } },
};

let studio: Studio;
let observer: Observer;

beforeAll(async () => {
  const files = Object.fromEntries(
    [LOOSE, APART, EYE].map((doc) => [`${doc.name}.json`, JSON.stringify(doc)]),
  );
  studio = await startStudio({ files, file: "loose.json" });
  observer = await studio.observe();
});

afterAll(() => studio.stop());

const banner = () => panel(studio.page, "Inspector").getByRole("alert");
const press = (name: string) => banner().getByRole("button", { name, exact: true }).click();
const line = (name: RegExp) => studio.page.getByRole("dialog").getByRole("option", { name }).first();

test("what nothing reads is connected or removed", async () => {
  const { page } = studio;
  await reopen(page, observer, "loose.json");
  await select(page, "left");
  await banner().getByText("nothing reads it").waitFor();
  expect(await banner().innerText()).not.toMatch(/model\.|--/);
  expect(await obstacles(page)).toEqual([]);
  await shot(page, "problem-loose");
  await press("Connect…");
  await line(/^u\b/).click();
  await observer.until(() => observer.document?.connections.length === 1);
  await page.keyboard.press("Control+z");
  await observer.until(() => observer.document?.connections.length === 0);
  await select(page, "left");
  await press("Remove it");
  await observer.until(() => observer.document?.elements.length === 1);
});

test("the coupling between two axes is chosen", async () => {
  const { page } = studio;
  await reopen(page, observer, "apart.json");
  await select(page, "v");
  await banner().getByText("does not fit").waitFor();
  await shot(page, "problem-apart");
  await press("Choose a coupling…");
  await line(/^Resample/).click();
  await observer.until(
    () => observer.document?.elements.length === 3 && observer.document.problems.length === 0,
  );
  expect(observer.document?.connections.length).toBe(2);
});

test("a box that was just made is not yet marked as one that nothing reads", async () => {
  const { page } = studio;
  await reopen(page, observer, "loose.json");
  await observer.ask({ type: "add_element", kind: "GaussianStimulus", name: "fresh", at: [0, 300] });
  const mark = box(page, "fresh").getByRole("button", { name: /^Warning: nothing reads it/ });
  await box(page, "fresh").waitFor();
  await observer.until(() => observer.document?.problems.some(({ where }) => where === "fresh") === true);
  expect(await mark.count()).toBe(0);
  await mark.waitFor();
});

test("another sensor is chosen for one that no world has", async () => {
  const { page } = studio;
  await reopen(page, observer, "eye.json");
  await select(page, "eye");
  await banner().getByText("no world was chosen that has the sensor 'sonar'").waitFor();
  await shot(page, "problem-eye");
  expect(await banner().getByRole("button").allInnerTexts()).toEqual([
    "Choose a sensor…",
    "Other world…",
    "Remove it",
  ]);
  await press("Choose a sensor…");
  await line(/^Infrared, 8 samples/).click();
  await observer.until(() => observer.document?.problems.length === 0);
  expect(observer.value("eye", "sensor")).toBe("infrared");
  await page.keyboard.press("Control+z");
  await observer.until(() => observer.value("eye", "sensor") === "sonar");
});
