/** A running studio with its page open in a browser, for one test. */
import { cpSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";

import type { Browser, BrowserContext, Page } from "playwright-core";

import { launch } from "./chromium";
import { Observer } from "./observer";
import { PATIENCE, type Server, type ServerOptions, startServer } from "./server";

const ROOT = join(import.meta.dirname, "..", "..");
const SIZE = { width: 1280, height: 800 };

export interface StudioOptions extends ServerOptions {
  /**
   * Files and folders of the repository that are copied into the working folder first, such as
   * examples/selection.json.
   */
  copies?: string[];
  /** Further files in it, by name, with their content. */
  files?: Record<string, string>;
  /** Folders in it, by name, with their files by name and content. */
  folders?: Record<string, Record<string, string>>;
  /** The folder of unsaved edits and of keys, if another process shares it. */
  state?: string;
  colours?: "light" | "dark";
  /** Messages of the browser's console that belong to the test, such as those of a lost connection. */
  expected?: RegExp[];
}

export interface Studio {
  page: Page;
  url: string;
  /** The working folder, which contains FILE. */
  folder: string;
  /** The folder of unsaved edits. */
  state: string;
  browser: Browser;
  context: BrowserContext;
  /** The running server. */
  readonly server: Server;
  /** End the server by a signal, and start it again at the same address. */
  restart: (signal?: NodeJS.Signals) => Promise<void>;
  /** Open a further page at the same server. */
  another: () => Promise<Page>;
  /** Connect a page without a browser, which reads exact numbers. */
  observe: () => Promise<Observer>;
  /** End browser and server; fail if a page reported an error. */
  stop: () => Promise<void>;
}

export async function startStudio(options: StudioOptions = {}): Promise<Studio> {
  const home = mkdtempSync(join(tmpdir(), "deodar-studio-"));
  const folder = join(home, "folder");
  mkdirSync(folder);
  for (const name of options.copies ?? [])
    cpSync(join(ROOT, name), join(folder, basename(name)), { recursive: true });
  for (const [name, content] of Object.entries(options.files ?? {}))
    writeFileSync(join(folder, name), content);
  for (const [name, files] of Object.entries(options.folders ?? {})) {
    mkdirSync(join(folder, name));
    for (const [file, content] of Object.entries(files)) writeFileSync(join(folder, name, file), content);
  }

  const closing: (() => Promise<void>)[] = [
    async () => rmSync(home, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 }),
  ];
  const close = async () => {
    for (const one of closing.splice(0).reverse()) await one();
  };
  const errors: string[] = [];
  try {
    const state = options.state ?? join(home, "state");
    let server = await startServer(folder, state, options);
    closing.push(() => server.stop());
    const restart = async (signal?: NodeJS.Signals) => {
      await server.stop(signal);
      const port = new URL(server.url).port;
      server = await startServer(folder, state, {
        ...options,
        words: [...(options.words ?? []), "--port", port],
      });
    };
    const browser = await launch();
    closing.push(() => browser.close());
    const context = await browser.newContext({
      viewport: SIZE,
      locale: "en-US",
      colorScheme: options.colours ?? "light",
      reducedMotion: "reduce",
      acceptDownloads: true,
    });
    context.setDefaultTimeout(PATIENCE);
    const another = async () => {
      const page = await context.newPage();
      const note = (text: string) => {
        if (!options.expected?.some((pattern) => pattern.test(text))) errors.push(text);
      };
      page.on("pageerror", (error) => note(error.stack ?? error.message));
      page.on("console", (message) => {
        if (message.type() === "error") note(`${message.text()} (${message.location().url})`);
      });
      await page.goto(server.url);
      return page;
    };
    const observe = async () => {
      const observer = await Observer.connect(server.url);
      observer.drawn = () => drawn(page);
      closing.push(async () => observer.close());
      return observer;
    };
    const page = await another();
    const stop = async () => {
      await close();
      if (errors.length > 0) throw new Error(`The page reported:\n${errors.join("\n")}`);
    };
    return {
      page,
      url: server.url,
      folder,
      state,
      browser,
      context,
      get server() {
        return server;
      },
      restart,
      another,
      observe,
      stop,
    };
  } catch (error) {
    await close();
    throw error;
  }
}

/** Write a picture of the page as NAME.png into the folder that DEODAR_SHOTS names, if it is set. */
export async function shot(page: Page, name: string): Promise<void> {
  const folder = process.env["DEODAR_SHOTS"];
  if (folder) await page.screenshot({ path: join(folder, `${name}.png`) });
}

/** Wait for two pictures of a page, at most two seconds: it may be closed, or its server gone. */
async function drawn(page: Page): Promise<void> {
  const pictures = page.evaluate(
    () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
  );
  const late = new Promise((done) => setTimeout(done, 2000).unref());
  await Promise.race([pictures, late]).catch(() => undefined);
}
