/** An installed Firefox, driven by WebDriver BiDi, which every current Firefox offers. */
import { existsSync } from "node:fs";

import puppeteer, { type Browser } from "puppeteer-core";

const PLACES = [
  "/usr/bin/firefox",
  "/usr/bin/firefox-esr",
  "/snap/bin/firefox",
  "/Applications/Firefox.app/Contents/MacOS/firefox",
  "C:/Program Files/Mozilla Firefox/firefox.exe",
];

export async function launchFirefox(): Promise<Browser> {
  const program = process.env["DEODAR_FIREFOX"] ?? PLACES.find((place) => existsSync(place));
  if (program === undefined)
    throw new Error(
      "No Firefox was found. Install it (Debian: apt install firefox-esr)," +
        " or set DEODAR_FIREFOX to its program.",
    );
  // the size is an argument, because an older Firefox does not have the command that sets it later
  const args = ["--width=1280", "--height=900"];
  return puppeteer.launch({
    browser: "firefox",
    executablePath: program,
    headless: true,
    defaultViewport: null,
    args,
  });
}
