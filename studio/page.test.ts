import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";

import { expect, test } from "vitest";

const BUILT = join(import.meta.dirname, "../src/deodar_studio/static/assets");

/** What matches in the built files with an ending. */
function matches(ending: string, pattern: RegExp): Set<string> {
  const files = readdirSync(BUILT).filter((name) => name.endsWith(ending));
  return new Set(files.flatMap((name) => readFileSync(join(BUILT, name), "utf8").match(pattern) ?? []));
}

test("every control that the built page names has its style, and no other has", () => {
  const [named, styled] = [matches(".js", /\bm_[0-9a-f]{6,8}\b/g), matches(".css", /\bm_[0-9a-f]{6,8}\b/g)];
  expect(named.size).toBeGreaterThan(50);
  expect([...named].filter((name) => !styled.has(name))).toEqual([]);
  expect([...styled].filter((name) => !named.has(name))).toEqual([]);
});
