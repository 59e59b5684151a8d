import { readFileSync } from "node:fs";

import { expect, test } from "vitest";

import { onlyUsed, onlyWoff2 } from "./fonts";

test("a font keeps its source in woff2 alone", () => {
  const css =
    `src:url(a.woff2) format("woff2"),url(a.woff) format("woff"),url('a.ttf') format('truetype');` +
    "color:red";
  expect(onlyWoff2(css)).toBe(`src:url(a.woff2) format("woff2");color:red`);
});

test("a font without woff2 is unchanged", () => {
  const css = `src: url(a.ttf) format("truetype")`;
  expect(onlyWoff2(css)).toBe(css);
});

test("the stylesheet of the formulas keeps no other source", () => {
  const css = onlyWoff2(readFileSync("node_modules/katex/dist/katex.min.css", "utf8"));
  expect(css).toContain("KaTeX_Main-Regular.woff2");
  expect(css).not.toMatch(/\.woff\)|\.ttf\)/);
});

test("of the alphabets of formulas only those remain that formulas have", () => {
  const css = readFileSync("node_modules/katex/dist/katex.min.css", "utf8");
  const families = (text: string) =>
    new Set([...text.matchAll(/@font-face\{font-\w+:[^}]*?KaTeX_(\w+)/g)].map((found) => found[1]));
  const used = families(onlyUsed(css));
  expect(used).toContain("Main");
  expect(used).toContain("Size4");
  expect([...families(css)].filter((family) => !used.has(family))).toEqual([
    "Fraktur",
    "SansSerif",
    "Script",
    "Typewriter",
  ]);
});

test("of the scripts of the typeface Latin and Greek remain", () => {
  const css = readFileSync("node_modules/@fontsource-variable/inter/wght.css", "utf8");
  const files = (text: string) =>
    [...text.matchAll(/url\(\.\/files\/inter-(.*?)-wght/g)].map(([, name]) => name);
  expect(files(css).length).toBeGreaterThan(5);
  expect(files(onlyUsed(css)).sort()).toEqual(["greek", "latin"]);
});
