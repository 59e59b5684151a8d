/**
 * A server with a document, and browsers that are connected to it. Nothing else of the tests' harness runs,
 * because the page is measured.
 */
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import type { Browser, Page } from "playwright-core";

import { launch } from "../chromium";
import { type Server, startServer } from "../server";

const SIZE = { width: 1280, height: 800 };
/** A page whose canvas has 1280 px. */
export const WIDE = { width: 1280 + 524, height: 800 };

export interface Stage {
  server: Server;
  browser: Browser;
  /**
   * A page of a new browser profile at the address of the server, with a script that runs before those of
   * the page.
   */
  open: (before?: string) => Promise<Page>;
}

/** Call a function with a stage on which this document is open, or the gallery. */
export async function onStage(
  document: object | null,
  act: (stage: Stage) => Promise<void>,
  viewport = SIZE,
): Promise<void> {
  const home = mkdtempSync(join(tmpdir(), "deodar-bench-"));
  const folder = join(home, "folder");
  mkdirSync(folder);
  const file = document === null ? undefined : "measured.json";
  if (file) writeFileSync(join(folder, file), JSON.stringify(document));
  const server = await startServer(folder, join(home, "state"), file ? { file } : {});
  try {
    const browser = await launch();
    const open = async (before = "") => {
      const context = await browser.newContext({ viewport, locale: "en-US", reducedMotion: "reduce" });
      const page = await context.newPage();
      if (before) await page.addInitScript({ content: before });
      await page.goto(server.url);
      return page;
    };
    try {
      await act({ server, browser, open });
    } finally {
      await browser.close();
    }
  } finally {
    await server.stop();
    rmSync(home, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
  }
}
