import { defineConfig } from "vitest/config";

/** The page in a real browser before a running studio: one test at a time, because each starts both. */
export default defineConfig({
  test: {
    include: ["browser/**/*.test.ts"],
    globalSetup: "browser/ready.ts",
    fileParallelism: false,
    testTimeout: 120_000,
    hookTimeout: 120_000,
  },
});
