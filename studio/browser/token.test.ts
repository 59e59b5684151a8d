import { rmSync } from "node:fs";
import { join } from "node:path";

import { expect, onTestFinished, test } from "vitest";

import { box } from "./hands";
import { PATIENCE, runPython } from "./server";
import { startStudio, type Studio } from "./studio";

/** The browser's messages for a server that does not run, or that requires another token. */
const GONE = [/WebSocket connection to .* failed/, /ERR_CONNECTION_REFUSED/, /status of 401/];

async function start(): Promise<Studio> {
  const studio = await startStudio({
    copies: ["examples/selection.json"],
    file: "selection.json",
    expected: GONE,
  });
  onTestFinished(studio.stop);
  return studio;
}

test("the address bar does not show the token, and a page without it asks for it", async () => {
  const { page, url, browser } = await start();
  await box(page, "u").waitFor();
  expect(page.url()).toBe(new URL("/", url).href);
  const context = await browser.newContext({ locale: "en-US", reducedMotion: "reduce" });
  context.setDefaultTimeout(PATIENCE);
  onTestFinished(() => context.close());
  const stranger = await context.newPage();
  await stranger.goto(new URL("/", url).href);
  await stranger.getByText("This studio needs its token").waitFor();
  await stranger.getByLabel("Token").fill(new URL(url).searchParams.get("token") ?? "");
  await stranger.getByRole("button", { name: "Open" }).click();
  await stranger.getByRole("toolbar", { name: "Run" }).waitFor();
  expect(stranger.url()).toBe(page.url());
});

test("the file that the studio opens in the browser leads to the page", async () => {
  const { url, browser } = await start();
  const code =
    "import sys; from deodar_studio.access.redirect_file import RedirectFile; " +
    "print(RedirectFile(sys.argv[1]).address)";
  const context = await browser.newContext({ locale: "en-US", reducedMotion: "reduce" });
  context.setDefaultTimeout(PATIENCE);
  onTestFinished(() => context.close());
  const page = await context.newPage();
  await page.goto((await runPython(["-c", code, url])).trim());
  await box(page, "u").waitFor();
  expect(page.url()).toBe(new URL("/", url).href);
});

test("a page whose studio restarts with another token shows the address to open", async () => {
  const studio = await start();
  const { page, state, restart, another } = studio;
  await box(page, "u").waitFor();
  rmSync(join(state, "tokens"), { recursive: true });
  await restart();
  await page.getByText("open the address that it printed").waitFor();
  const second = await another();
  await box(second, "u").waitFor();
  await page.getByText("open the address that it printed").waitFor({ state: "detached" });
});
