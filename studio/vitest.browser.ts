import { defineConfig } from "vitest/config";

/** The page in a real browser before a running studio: two files at a time, because each starts both. */
export default defineConfig({
  test: {
    include: ["browser/**/*.test.ts"],
    globalSetup: "browser/ready.ts",
    maxWorkers: 2,
    // long, because other tests may take most of the machine: what is slow is measured by `build.py bench`
    testTimeout: 400_000,
    hookTimeout: 400_000,
    expect: { poll: { timeout: 180_000, interval: 50 } },
    // the observer needs what node has only from version 22 on without being asked
    execArgv: "WebSocket" in globalThis ? [] : ["--experimental-websocket"],
  },
});
