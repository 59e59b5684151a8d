import { readdirSync, readFileSync } from "node:fs";

import { expect, it } from "vitest";

it("the drawing imports nothing else of the page, and no library", () => {
  const files = readdirSync(import.meta.dirname).filter((name) => !name.includes(".test."));
  expect(files.length).toBeGreaterThan(10);
  const others = files.flatMap((name) => {
    const text = readFileSync(`${import.meta.dirname}/${name}`, "utf8");
    return [...text.matchAll(/from "(?!\.\/)(.*)"/g)].map(([, path]) => `${name} imports ${path}`);
  });
  expect(others).toEqual([]);
});
