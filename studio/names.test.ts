import { readdirSync, readFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { expect, test } from "vitest";

const MOST = 40;
const SOURCES = fileURLToPath(new URL("src/", import.meta.url));
const files = readdirSync(SOURCES, { recursive: true, encoding: "utf8" }).filter((file) =>
  /(?<!\.test)\.(tsx?|css)$/.test(file),
);

// A disk may ignore case, and an import names no ending: "pins" must be one script.
test("no two files of the page have the same name, whatever its case and ending", () => {
  const scripts = files.filter((file) => !file.endsWith(".css"));
  expect(
    doubled(
      scripts.map((file) =>
        basename(file)
          .replace(/\.tsx?$/, "")
          .toLowerCase(),
      ),
    ),
  ).toEqual([]);
  expect(doubled(files.map((file) => basename(file).toLowerCase()))).toEqual([]);
});

test("no two exported types, classes and components of the page have the same name", () => {
  const names = files.flatMap((file) =>
    [
      ...readFileSync(join(SOURCES, file), "utf8").matchAll(
        /^export (?:class|const|function|interface|type) ([A-Z]\w*[a-z]\w*)/gm,
      ),
    ].map((match) => match[1] ?? ""),
  );
  expect(names.length).toBeGreaterThan(200);
  expect(doubled(names)).toEqual([]);
});

test("a folder of the page has at most 40 files without tests", () => {
  const counts = new Map<string, number>();
  for (const file of files) {
    counts.set(dirname(file), (counts.get(dirname(file)) ?? 0) + 1);
  }
  expect(counts.size).toBeGreaterThan(20);
  expect([...counts].filter(([, count]) => count > MOST)).toEqual([]);
});

function doubled(names: string[]): string[] {
  return names.filter((name, i) => names.indexOf(name) !== i);
}
