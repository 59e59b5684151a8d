// The tools of the dock: each file `NAME.tool.tsx` of the page declares one.

import type { View } from "../state/page";
import type { DockTool } from "../state/tool";

const FILES = import.meta.glob<DockTool>("../**/*.tool.tsx", { eager: true, import: "tool" });

// By name; first those that the dock always has, in the order of their tabs, then by title.
export const TOOLS: ReadonlyMap<string, DockTool> = new Map(
  Object.entries(FILES)
    .map(([file, tool]) => [file.replace(/^.*\/|\.tool\.tsx$/g, ""), tool] as const)
    .sort(
      ([, a], [, b]) => (a.tab ?? Infinity) - (b.tab ?? Infinity) || a.title.localeCompare(b.title, "en"),
    ),
);

export const STANDING = [...TOOLS].flatMap(([name, { tab }]) => (tab === undefined ? [] : [name]));

export const isStanding = (name: string): boolean => STANDING.includes(name);

// The tool that a view shows first.
export const firstTool = (view: View): string =>
  [...TOOLS].find(([, { firstIn }]) => firstIn?.includes(view))?.[0] ?? "";
