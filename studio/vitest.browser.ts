import { defineConfig } from "vitest/config";

/** The page in a real browser before a running studio: two files at a time, because each starts both. */
export default defineConfig({
  test: {
    include: ["browser/**/*.test.ts"],
    globalSetup: "browser/ready.ts",
    maxWorkers: 2,
    testTimeout: 120_000,
    hookTimeout: 120_000,
    expect: { poll: { timeout: 60_000, interval: 50 } },
    // the observer needs what node has only from version 22 on without being asked
    execArgv: "WebSocket" in globalThis ? [] : ["--experimental-websocket"],
  },
});
