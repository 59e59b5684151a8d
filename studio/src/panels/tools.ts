// The tools of the page: their titles, and the views in whose centre some of them are; the others are tabs of
// the dock.

import type { View } from "../state/page";

export type Tool =
  | "inspector"
  | "pins"
  | "regime"
  | "notes"
  | "activity"
  | "costs"
  | "report"
  | "graph"
  | "palette"
  | "experiment"
  | "world";

export const TOOLS: Record<Tool, { title: string; view?: View }> = {
  inspector: { title: "Inspector" },
  pins: { title: "Sliders" },
  regime: { title: "Regime" },
  notes: { title: "Notes" },
  activity: { title: "Activity" },
  costs: { title: "Costs" },
  report: { title: "Import report" },
  graph: { title: "Architecture", view: "build" },
  palette: { title: "Elements", view: "build" },
  experiment: { title: "Experiment", view: "experiment" },
  world: { title: "World", view: "robot" },
};

export const TOOL_NAMES = Object.keys(TOOLS) as Tool[];

// The tabs that the dock always has; one more shows a tool that was opened besides.
export const STANDING: readonly Tool[] = ["inspector", "pins", "regime", "notes"];

export const FIRST_TOOL: Record<View, Tool> = {
  build: "inspector",
  run: "pins",
  experiment: "inspector",
  robot: "pins",
};

export const isStanding = (value: unknown): value is Tool => STANDING.includes(value as Tool);
