import { defineConfig } from "vitest/config";

/** The logic of the page, without a browser. */
export default defineConfig({
  test: { include: ["src/**/*.test.{ts,tsx}", "*.test.ts"] },
});
