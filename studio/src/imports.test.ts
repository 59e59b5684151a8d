import { readdirSync, readFileSync } from "node:fs";
import { dirname, join, normalize, relative, sep } from "node:path";

import { expect, it } from "vitest";

const ROOT = import.meta.dirname;
const files = readdirSync(ROOT, { recursive: true, encoding: "utf8" })
  .map((name) => name.replaceAll(sep, "/"))
  .filter((name) => /\.(tsx?|css)$/.test(name) && !name.includes(".test."));
const scripts = files.filter((name) => !name.endsWith(".css"));

// The files of the page that a file imports, types and style sheets included.
function imported(file: string): string[] {
  const text = readFileSync(join(ROOT, file), "utf8");
  const below = (path: string) =>
    relative(ROOT, normalize(join(ROOT, dirname(file), path))).replaceAll(sep, "/");
  const paths = [...text.matchAll(/(?:from |import |import\()"(\.[^"]+)"/g)].map(([, path = ""]) =>
    below(path),
  );
  const patterns = [...text.matchAll(/import\.meta\.glob<\w+>\("(\.[^"*]+)\*+(?:\/\*)?([^"*]+)"/g)].map(
    ([, folder = "", ending = ""]) => [below(folder), ending] as const,
  );
  return [
    ...paths.flatMap((path) => files.filter((name) => [path, `${path}.ts`, `${path}.tsx`].includes(name))),
    ...patterns.flatMap(([folder, ending]) =>
      scripts.filter((name) => name !== file && name.startsWith(folder) && name.endsWith(ending)),
    ),
  ];
}

const imports = new Map(scripts.map((file) => [file, imported(file)]));

it("no file of the page imports itself, over whatever others", () => {
  expect([...imports.values()].flat().length).toBeGreaterThan(1000);
  const done = new Set<string>();
  const circles: string[] = [];
  const visit = (file: string, path: readonly string[]): void => {
    if (path.includes(file)) {
      circles.push([...path.slice(path.indexOf(file)), file].join(" > "));
    } else if (!done.has(file)) {
      for (const next of imports.get(file) ?? []) visit(next, [...path, file]);
      done.add(file);
    }
  };
  for (const file of scripts) visit(file, []);
  expect(circles).toEqual([]);
});

// A table in the README of the server has the order of the folders; `main.tsx` is what lies in no folder.
it("a folder of the page imports only folders above it in the table of folders", () => {
  const readme = readFileSync(join(ROOT, "../../src/deodar_studio/README.md"), "utf8");
  const table = readme.slice(readme.indexOf("\n## The page\n"), readme.indexOf("\n## Adding\n"));
  const order = [...table.matchAll(/^\| `([^`]+?)\/?` \|/gm)].map(([, folder = ""]) => folder);
  const folderOf = (file: string) => {
    const folder = dirname(file);
    return folder !== "." ? folder : file === "protocol.ts" ? file : "main.tsx";
  };
  const folders = [...new Set(files.map(folderOf))];
  expect(folders.length).toBeGreaterThan(20);
  expect(folders.toSorted()).toEqual(order.toSorted());
  const upwards = scripts.flatMap((file) =>
    (imports.get(file) ?? [])
      .filter((other) => order.indexOf(folderOf(other)) > order.indexOf(folderOf(file)))
      .map((other) => `${file} imports ${other}`),
  );
  expect(upwards).toEqual([]);
});
