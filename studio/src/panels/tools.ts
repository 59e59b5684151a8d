// The panels that exist once: what they are called, and where they go.

export type Tool = "graph" | "inspector" | "pins" | "costs" | "world";

export const TOOLS: Record<Tool, { title: string; direction: "left" | "right"; width: number }> = {
  graph: { title: "Architecture", direction: "left", width: 700 },
  inspector: { title: "Inspector", direction: "right", width: 330 },
  pins: { title: "Sliders", direction: "right", width: 330 },
  costs: { title: "Costs", direction: "right", width: 400 },
  world: { title: "World", direction: "right", width: 460 },
};

export const TOOL_NAMES = Object.keys(TOOLS) as Tool[];
