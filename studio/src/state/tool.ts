// What a tool of the dock states about itself, and how it is opened from anywhere. Each file `NAME.tool.tsx`
// declares one.

import type { ComponentType } from "react";

import { usePage, type View } from "./page";

export type DockTool = Readonly<{
  title: string;
  // Its place among the tabs that the dock always has; a tool without one is a tab when it was opened.
  tab?: number;
  // The views that show it first.
  firstIn?: readonly View[];
  component: ComponentType;
}>;

export function openTool(name: string): void {
  usePage.setState(({ view, tabs, opened }) => ({
    tabs: { ...tabs, [view]: name },
    opened: [...opened.filter((other) => other !== name), name],
  }));
}
