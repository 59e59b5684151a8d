import { defineConfig } from "vitest/config";

/** The pictures of the manual, taken of a running studio: `studio/build.py pictures` starts it. */
export default defineConfig({
  test: {
    include: ["browser/pictures/*.shots.ts"],
    globalSetup: "browser/ready.ts",
    fileParallelism: false,
    testTimeout: 180_000,
    hookTimeout: 120_000,
    // the observer needs what node has only from version 22 on without being asked
    execArgv: "WebSocket" in globalThis ? [] : ["--experimental-websocket"],
  },
});
