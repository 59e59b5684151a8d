/** The tests that every browser has to pass: what a page does in the first minutes of its user. */
import { mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import { afterAll, afterEach, beforeAll, beforeEach, expect, test } from "vitest";

import { Observer } from "../observer";
import { type Server, startServer } from "../server";
import type { Driver } from "./driver";

type Point = readonly [x: number, y: number];

/** Where an element is on the page. */
interface Place {
  left: number;
  top: number;
  width: number;
  height: number;
}

/** Declare the tests for one browser. */
export function smoke(name: string, launch: () => Promise<Driver>): void {
  let home: string;
  let server: Server;
  let observer: Observer;
  let page: Driver;

  beforeAll(async () => {
    home = mkdtempSync(join(tmpdir(), "deodar-engine-"));
    mkdirSync(join(home, "folder"));
    server = await startServer(join(home, "folder"), join(home, "state"));
    observer = await Observer.connect(server.url);
    page = await launch();
    await page.open(server.url);
  });

  afterAll(async () => {
    await page?.close();
    observer?.close();
    await server?.stop();
    rmSync(home, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
  });

  beforeEach(async () => {
    await page.move(0, 0);
  });

  afterEach(async ({ task }) => {
    const folder = process.env["DEODAR_SHOTS"];
    if (folder)
      await page.picture(join(folder, `${name}-${task.name.slice(0, 30).replace(/\W+/g, "-")}.png`));
    expect(await page.errors()).toEqual([]);
  });

  /** The first visible element that a selector finds, once there is one, and where it is. */
  async function place(selector: string): Promise<Place> {
    // the selectors of the drivers are evaluated as text, which the page forbids
    const find = () =>
      page.evaluate((wanted) => {
        for (const found of document.querySelectorAll(wanted)) {
          const { left, top, width, height } = found.getBoundingClientRect();
          if (width > 0 && height > 0) return { left, top, width, height };
        }
        return null;
      }, selector);
    await expect.poll(find, { message: selector }).not.toBeNull();
    return (await find()) ?? { left: 0, top: 0, width: 0, height: 0 };
  }

  async function middle(selector: string): Promise<Point> {
    const { left, top, width, height } = await place(selector);
    return [left + width / 2, top + height / 2];
  }

  async function click([x, y]: Point): Promise<void> {
    await page.move(x, y);
    await page.down();
    await page.up();
  }

  async function type(text: string): Promise<void> {
    for (const letter of text) await page.press(letter);
  }

  async function open(example: string): Promise<void> {
    await observer.ask({ type: "open_example", name: example, discard: true });
    await observer.until(() => observer.document?.title === example);
    await observer.runs();
    await place(".graph-box");
  }

  const box = (path: string) => `.react-flow__node[aria-label^="${path}, "]`;
  const count = () => observer.document?.elements.length;

  /** Number of colours on all canvases that a selector finds: on an empty canvas there is one. */
  function colours(selector: string): Promise<number> {
    return page.evaluate((wanted) => {
      const found = new Set<number>();
      for (const canvas of document.querySelectorAll<HTMLCanvasElement>(wanted)) {
        const copy = document.createElement("canvas");
        [copy.width, copy.height] = [canvas.width, canvas.height];
        const context = copy.getContext("2d");
        if (context === null || canvas.width * canvas.height === 0) continue;
        context.drawImage(canvas, 0, 0);
        const { data } = context.getImageData(0, 0, copy.width, copy.height);
        for (const value of new Uint32Array(data.buffer)) found.add(value);
      }
      return found.size;
    }, selector);
  }

  test(`${name}: an example runs, its boxes and plots are drawn live, and a key stops it`, async () => {
    await open("selection");
    await click(await middle('button[aria-label="Play"]:enabled'));
    await place('button[aria-label="Pause"]');
    await observer.until(() => observer.max("left", "output") > 4);
    await expect.poll(() => colours(".graph-live-layer")).toBeGreaterThan(10);
    await expect.poll(() => colours(".plot canvas")).toBeGreaterThan(10);

    await click(await middle(`${box("u")} .graph-box-name`));
    await place('[role="slider"]');
    await place(".katex .mfrac");
    await page.press(" ");
    await place('button[aria-label="Play"]');
    await observer.until(() => !observer.running);
  });

  test(`${name}: the palette and a dragged wire build a model, which copy and paste double`, async () => {
    await observer.ask({ type: "new", discard: true });
    // the canvas of the document before is replaced
    await expect
      .poll(() => page.evaluate((path) => document.querySelector(path)?.textContent, "body"))
      .toContain("no elements yet");
    const ground = await place(".react-flow__pane");
    const at = (across: number, down: number): Point => [
      ground.left + ground.width * across,
      ground.top + ground.height * down,
    ];
    const gone = (selector: string) =>
      expect.poll(() => page.evaluate((path) => document.querySelectorAll(path).length, selector)).toBe(0);
    await gone(".graph-box");
    await page.doubleClick(...at(0.2, 0.3));
    await place('[role="dialog"] input:focus');
    await type("gau");
    await page.press("Enter");
    await observer.until(() => count() === 1);
    // the page shows it after the server has it; the palette that closes still has the focus for a moment
    await place(box("gaussian_stimulus"));
    await gone('[role="dialog"]');
    await page.doubleClick(...at(0.7, 0.6));
    await place('[role="dialog"] input:focus');
    await type("field");
    await page.press("Enter");
    await observer.until(() => count() === 2);
    await place(box("field"));
    await gone('[role="dialog"]');

    const [from, to] = [
      await middle(`${box("gaussian_stimulus")} .react-flow__handle[data-handleid="output"]`),
      await middle(`${box("field")} .react-flow__handle[data-handleid="input"]`),
    ];
    await page.move(...from);
    await page.down();
    await page.move((from[0] + to[0]) / 2, (from[1] + to[1]) / 2);
    await page.move(...to);
    await page.up();
    await observer.until(() => observer.document?.connections.length === 1);
    await place(".graph-wire");

    await click(at(0.5, 0.95));
    for (const key of ["a", "c", "v"]) await page.press(key, "Control");
    await observer.until(() => count() === 4 && observer.document?.connections.length === 2);
    await place(box("field2"));
    await page.press("z", "Control");
    await observer.until(() => count() === 2);
  });

  test(`${name}: the right button on a plot injects an input for as long as it is held`, async () => {
    await open("selection");
    for (const path of ["left", "right"])
      await observer.ask({
        type: "set",
        element: observer.element(path).id,
        parameter: "amplitude",
        value: 0,
      });
    await observer.ask({ type: "play" });
    await observer.until(() => observer.max("u", "activation") < 0);
    const pushing = () => observer.clock?.pushing === observer.element("u").id;
    let pressed = false;
    // panels still move for a moment after a document is opened
    await expect
      .poll(async () => {
        if (pressed) await page.up("right");
        const { left, top, width, height } = await place(".plot .plot-over");
        await page.move(left + width * 0.25, top + height / 2);
        await page.down("right");
        pressed = true;
        await new Promise((resolve) => setTimeout(resolve, 500));
        return pushing();
      })
      .toBe(true);
    await observer.until(() => observer.max("u", "activation") > 3);
    expect(Math.abs(observer.peak("u", "activation") - 25)).toBeLessThan(8);
    await page.up("right");
    await observer.until(() => observer.clock?.pushing === "" && observer.max("u", "activation") < 0);
  });
}
