import { defineConfig } from "vitest/config";

/** The page in an installed Firefox before a running studio: `studio/build.py firefox` starts it. */
export default defineConfig({
  test: {
    include: ["browser/firefox/*.firefox.ts"],
    fileParallelism: false,
    testTimeout: 120_000,
    hookTimeout: 120_000,
  },
});
