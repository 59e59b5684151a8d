import { expect, test } from "vitest";

import { isRefused } from "./refused";

test("only a server that requires another token refuses this page", async () => {
  expect(await isRefused(async () => ({ status: 401 }))).toBe(true);
  expect(await isRefused(async () => ({ status: 200 }))).toBe(false);
  expect(await isRefused(() => Promise.reject(new Error("connection refused")))).toBe(false);
});
