import { mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import type { Browser, Page } from "puppeteer-core";
import { afterEach, beforeEach, expect, test } from "vitest";

import { type Server, startServer } from "../server";
import { launchFirefox } from "./launch";

let home: string;
let server: Server;
let browser: Browser;
let page: Page;
let errors: string[];

beforeEach(async () => {
  home = mkdtempSync(join(tmpdir(), "deodar-firefox-"));
  mkdirSync(join(home, "folder"));
  server = await startServer(join(home, "folder"), join(home, "state"), { file: "example:selection" });
  browser = await launchFirefox();
  page = await browser.newPage();
  errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => {
    if (message.type() === "error") errors.push(message.text());
  });
  await page.goto(server.url);
});

afterEach(async () => {
  await browser.close();
  await server.stop();
  rmSync(home, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
  expect(errors).toEqual([]);
});

/**
 * Click the middle of the first visible element that a selector finds. The selectors of the driver itself
 * are evaluated as text, which the page forbids.
 */
async function click(selector: string): Promise<void> {
  await appears(selector);
  const [x, y] = await page.evaluate((wanted) => {
    const box = document.querySelector(wanted)?.getBoundingClientRect() ?? new DOMRect();
    return [box.x + box.width / 2, box.y + box.height / 2] as const;
  }, selector);
  await page.mouse.click(x, y);
}

async function appears(selector: string): Promise<void> {
  const count = () => page.evaluate((wanted) => document.querySelectorAll(wanted).length, selector);
  await expect.poll(count, { timeout: 60_000, message: selector }).toBeGreaterThan(0);
}

/** Number of colours in all canvases of the page: of an empty canvas there is one. */
async function colours(): Promise<number> {
  return page.evaluate(() => {
    const found = new Set<number>();
    for (const canvas of document.querySelectorAll("canvas")) {
      const copy = document.createElement("canvas");
      [copy.width, copy.height] = [canvas.width, canvas.height];
      const context = copy.getContext("2d");
      if (context === null || canvas.width * canvas.height === 0) continue;
      context.drawImage(canvas, 0, 0);
      const { data } = context.getImageData(0, 0, copy.width, copy.height);
      for (const value of new Uint32Array(data.buffer)) found.add(value);
    }
    return found.size;
  });
}

test("an example runs, draws its boxes, and answers a key and the mouse", async () => {
  await click('button[aria-label="Play"]:enabled');
  await appears('button[aria-label="Pause"]');
  await expect.poll(colours, { timeout: 60_000 }).toBeGreaterThan(20);

  await click(".graph-box");
  await appears('[role="slider"]');
  const folder = process.env["DEODAR_SHOTS"];
  await appears(".katex .mfrac");
  await page.evaluate(() => document.fonts.ready.then(() => undefined));
  if (folder) await page.screenshot({ path: join(folder, "firefox.png") as `${string}.png` });
  await page.keyboard.type(" ");
  await appears('button[aria-label="Play"]');
});
