import { expect, test } from "vitest";

import { isRefused } from "./refused";

test("a server that wants another token refuses this page; one that answers, or does not answer, does not", async () => {
  expect(await isRefused(async () => ({ status: 401 }))).toBe(true);
  expect(await isRefused(async () => ({ status: 200 }))).toBe(false);
  expect(await isRefused(() => Promise.reject(new Error("connection refused")))).toBe(false);
});
