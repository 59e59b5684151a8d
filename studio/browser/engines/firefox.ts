/** An installed Firefox, driven by WebDriver BiDi, which every current Firefox offers. */
import puppeteer, { type KeyInput } from "puppeteer-core";

import { type Driver, programOf } from "./driver";

export async function launchFirefox(): Promise<Driver> {
  const browser = await puppeteer.launch({
    browser: "firefox",
    executablePath: programOf("DEODAR_FIREFOX"),
    headless: true,
    defaultViewport: null,
    // the size is an argument, because an older Firefox does not have the command that sets it later
    args: ["--width=1280", "--height=900"],
  });
  const page = await browser.newPage();
  let errors: string[] = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => {
    if (message.type() === "error") errors.push(message.text());
  });
  return {
    open: async (url) => {
      errors = [];
      await page.goto(url);
    },
    evaluate: async (look, argument) =>
      (await page.evaluate(look as (argument: unknown) => unknown, argument)) as ReturnType<typeof look>,
    move: (x, y) => page.mouse.move(x, y, { steps: 4 }),
    down: (button = "left") => page.mouse.down({ button }),
    up: (button = "left") => page.mouse.up({ button }),
    doubleClick: (x, y) => page.mouse.click(x, y, { count: 2 }),
    press: async (key, modifier) => {
      if (modifier) await page.keyboard.down(modifier);
      await page.keyboard.press(key as KeyInput);
      if (modifier) await page.keyboard.up(modifier);
    },
    picture: async (path) => {
      await page.screenshot({ path: path as `${string}.png` });
    },
    errors: async () => errors,
    close: () => browser.close(),
  };
}
