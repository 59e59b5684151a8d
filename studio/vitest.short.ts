import { defineConfig, mergeConfig } from "vitest/config";

import browser from "./vitest.browser";

/** Files that take longer than half a minute beside other tests: `make whole` runs them. */
const LONG = [
  "build",
  "experiment",
  "eye",
  "foreign",
  "large",
  "legible",
  "lesson",
  "liveEdits",
  "plotKinds",
  "plots",
  "record",
  "regime",
  "replay",
  "sensors",
  "starving",
  "sturdy",
  "tuning",
  "wires",
  "world",
];

/** The page in a real browser, without the files that take long. */
export default defineConfig(
  mergeConfig(browser, { test: { exclude: LONG.map((name) => `browser/${name}.test.ts`) } }),
);
