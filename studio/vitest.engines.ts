import { defineConfig } from "vitest/config";

/**
 * The page in an installed Firefox or WebKit before a running studio: `studio/build.py firefox` and `webkit`
 * start it.
 */
export default defineConfig({
  test: {
    include: ["browser/engines/*.engine.ts"],
    fileParallelism: false,
    testTimeout: 120_000,
    hookTimeout: 120_000,
    expect: { poll: { timeout: 60_000, interval: 50 } },
    execArgv: "WebSocket" in globalThis ? [] : ["--experimental-websocket"],
  },
});
