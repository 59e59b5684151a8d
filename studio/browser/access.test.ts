import type { Page } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";

import { findings, obstacles } from "./axe";
import { box, button, choose, openExample, openTool, panel, select } from "./hands";
import { shot, startStudio, type Studio } from "./studio";

let studio: Studio;

beforeAll(async () => {
  studio = await startStudio();
});

afterAll(() => studio.stop());

/** The visible controls without an accessible name. */
async function nameless(page: Page): Promise<string[]> {
  const lines = (await page.locator("body").ariaSnapshot()).split("\n").map((line) => line.trim());
  const roles =
    "button checkbox combobox link menuitem option radio searchbox slider spinbutton switch tab textbox";
  const controls = new RegExp(`^- (${roles.replaceAll(" ", "|")})\\b(.*)$`);
  return lines.filter((line) => {
    const found = controls.exec(line.replace(/^- '(.*)'(:?)$/, "- $1$2"));
    return found !== null && !/^ "[^"]+/.test(found[2] ?? "");
  });
}

/** The element that has the focus, and whether the focus is visible. */
function focused(page: Page): Promise<{ name: string; where: string; seen: boolean }> {
  return page.evaluate(() => {
    const element = document.activeElement ?? document.body;
    const looks = [element, element.parentElement, element.firstElementChild]
      .filter((one) => one !== null)
      .map((one) => getComputedStyle(one));
    const lines = (style: CSSStyleDeclaration) =>
      style.outlineStyle !== "none" && Number.parseFloat(style.outlineWidth) > 0;
    const around = ["header", "footer", "[role=tabpanel]", "[role=tablist]", "[role=region]"]
      .map((sort) => element.closest(sort))
      .find((one) => one !== null);
    return {
      name: element.getAttribute("aria-label") ?? (element as HTMLElement).innerText ?? "",
      where:
        around?.getAttribute("aria-label") ??
        around?.getAttribute("aria-labelledby") ??
        around?.tagName ??
        "",
      seen: looks.some((style) => lines(style) || style.boxShadow !== "none") || element.matches("input"),
    };
  });
}

/**
 * The contrast between the colour of a text and its background, as the guidelines for accessible content
 * define it.
 */
function contrast(page: Page, selector: string): Promise<number> {
  return page
    .locator(selector)
    .first()
    .evaluate((element) => {
      const pixel = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
      const rgba = (color: string): number[] => {
        if (pixel === null) return [];
        pixel.clearRect(0, 0, 1, 1);
        pixel.fillStyle = color;
        pixel.fillRect(0, 0, 1, 1);
        return [...pixel.getImageData(0, 0, 1, 1).data];
      };
      const light = (color: number[]): number => {
        const [r = 0, g = 0, b = 0] = color.map((part) =>
          part / 255 <= 0.04045 ? part / 255 / 12.92 : ((part / 255 + 0.055) / 1.055) ** 2.4,
        );
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      let ground: Element | null = element;
      while (ground !== null && (rgba(getComputedStyle(ground).backgroundColor)[3] ?? 0) < 255)
        ground = ground.parentElement;
      const below = light(rgba(ground === null ? "white" : getComputedStyle(ground).backgroundColor));
      const text = light(rgba(getComputedStyle(element).color));
      return (Math.max(text, below) + 0.05) / (Math.min(text, below) + 0.05);
    });
}

test("every control of the gallery has a name", async () => {
  const { page } = studio;
  await page.getByRole("heading", { name: "Examples" }).waitFor();
  expect(await nameless(page)).toEqual([]);
  expect(await obstacles(page)).toEqual([]);
  await button(page, "Open a file").click();
  await page.getByRole("dialog", { name: "Open a file" }).waitFor();
  expect(await nameless(page)).toEqual([]);
  await page.keyboard.press("Escape");
});

test("the gallery works by keyboard alone", async () => {
  const { page } = studio;
  await page.getByRole("button", { name: /^Selection / }).focus();
  await page.keyboard.press("Enter");
  await page.getByRole("toolbar", { name: "Run" }).waitFor();
  await choose(page, "File menu", /^Close/);
});

test("every control of an open document, also in its menus, has a name", async () => {
  const { page } = studio;
  await openExample(page, "Selection");
  expect(await nameless(page)).toEqual([]);
  await select(page, "u");
  expect(await nameless(page)).toEqual([]);
  await panel(page, "Inspector").locator(".katex").first().waitFor();
  expect(await obstacles(page)).toEqual([]);
  await choose(page, "More for tau", "Pin to Sliders");
  await openTool(page, "Sliders");
  await panel(page, "Sliders").getByRole("slider", { name: "u.tau" }).waitFor();
  for (const name of [
    "File menu",
    "Open panels and plots",
    "What to record",
    "Run settings",
    "Speed: 1×",
    "Settings of this plot",
    "Menu of this plot",
    "More for u.tau",
  ]) {
    await button(page, name).click();
    await page.getByRole("menu").or(page.getByRole("dialog")).first().waitFor();
    expect(await nameless(page), name).toEqual([]);
    expect(await obstacles(page), name).toEqual([]);
    await page.keyboard.press("Escape");
    await page.getByRole("menu").or(page.getByRole("dialog")).first().waitFor({ state: "detached" });
  }
  await select(page, "left");
  expect(await nameless(page)).toEqual([]);
});

test("the tab key reaches the run, the boxes and the inspector, and the focus is visible", async () => {
  const { page } = studio;
  await select(page, "u");
  await page.getByRole("button", { name: "File menu" }).focus();
  const stops: { name: string; where: string; seen: boolean }[] = [];
  for (let i = 0; i < 120; i++) {
    await page.keyboard.press("Tab");
    const stop = await focused(page);
    stops.push(stop);
    if (stop.name === "Speed: 1×") break;
  }
  const names = stops.map(({ name }) => name);
  for (const name of [
    "Play",
    "Reset",
    "Speed: 1×",
    "u, Field",
    "left, Gaussian stimulus",
    "Zoom in",
    "tau",
    "global_inhibition",
  ]) {
    expect(names).toContain(name);
  }
  expect(names.indexOf("u, Field")).toBeLessThan(names.indexOf("tau"));
  expect(names.indexOf("tau")).toBeLessThan(names.indexOf("Play"));
  expect(stops.filter(({ seen }) => !seen)).toEqual([]);
  await box(page, "left").focus();
  await page.keyboard.press("Enter");
  await panel(page, "Inspector").getByRole("heading", { name: "left", exact: true }).waitFor();
});

test("the colours follow the system until the user chooses, and text has contrast in both", async () => {
  const { page } = studio;
  const scheme = () =>
    page.evaluate(() => document.documentElement.getAttribute("data-mantine-color-scheme"));
  const texts = [
    "header h1",
    ".graph-box-name",
    ".graph-box-kind",
    ".inspector-header h2",
    ".kind-title",
    ".row-name",
    ".plot-path",
    ".plot-chip",
  ];
  await select(page, "u");
  await expect.poll(scheme).toBe("light");
  for (const [now, other] of [
    ["light", "Dark colours"],
    ["dark", "Light colours"],
  ] as const) {
    await expect.poll(scheme).toBe(now);
    for (const text of texts)
      expect(await contrast(page, text), `${text}, ${now}`).toBeGreaterThanOrEqual(4.5);
    expect(await findings(page, ["color-contrast"]), now).toEqual([]);
    await shot(page, `access-${now}`);
    await button(page, other).click();
  }
  await expect.poll(scheme).toBe("light");
});
