// The panels that exist once: their names and places.

export type Tool =
  "graph" | "inspector" | "pins" | "costs" | "world" | "palette" | "experiment" | "report" | "regime";

export const TOOLS: Record<Tool, { title: string; direction: "left" | "right"; width: number }> = {
  graph: { title: "Architecture", direction: "left", width: 700 },
  inspector: { title: "Inspector", direction: "right", width: 330 },
  pins: { title: "Sliders", direction: "right", width: 330 },
  costs: { title: "Costs", direction: "right", width: 400 },
  palette: { title: "Elements", direction: "left", width: 300 },
  world: { title: "World", direction: "right", width: 460 },
  experiment: { title: "Experiment", direction: "right", width: 460 },
  regime: { title: "Regime", direction: "right", width: 400 },
  report: { title: "Import report", direction: "right", width: 460 },
};

export const TOOL_NAMES = Object.keys(TOOLS) as Tool[];
