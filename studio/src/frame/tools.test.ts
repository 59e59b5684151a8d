import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";

import { expect, it } from "vitest";

import { VIEWS } from "../state/page";
import { firstTool, STANDING, TOOLS } from "./tools";

it("the tools that the dock always has come first, by their tabs, then the others by title", () => {
  const tabs = STANDING.map((name) => TOOLS.get(name)?.tab ?? 0);
  expect(tabs.length).toBeGreaterThan(2);
  expect(new Set(tabs).size).toBe(tabs.length);
  expect(tabs).toEqual(tabs.toSorted());
  expect([...TOOLS.keys()].slice(0, tabs.length)).toEqual(STANDING);
  const others = [...TOOLS.values()].slice(tabs.length).map(({ title }) => title);
  expect(others).toContain("Costs");
  expect(others).toEqual(others.toSorted());
});

it("no two tools have one title", () => {
  const titles = [...TOOLS.values()].map(({ title }) => title);
  expect(titles.length).toBeGreaterThan(5);
  expect(new Set(titles).size).toBe(titles.length);
});

it("each view begins with one tool, which the dock always has", () => {
  for (const view of VIEWS) {
    expect([...TOOLS.values()].filter(({ firstIn }) => firstIn?.includes(view))).toHaveLength(1);
    expect(STANDING).toContain(firstTool(view));
  }
});

it("what the page opens by name is a tool", () => {
  const root = join(import.meta.dirname, "..");
  const names = readdirSync(root, { recursive: true, encoding: "utf8" })
    .filter((file) => /(?<!\.test)\.tsx?$/.test(file))
    .flatMap((file) => [...readFileSync(join(root, file), "utf8").matchAll(/\bopenTool\("(\w+)"\)/g)])
    .map(([, name = ""]) => name);
  expect(names.length).toBeGreaterThan(3);
  expect(names.filter((name) => !TOOLS.has(name))).toEqual([]);
});
