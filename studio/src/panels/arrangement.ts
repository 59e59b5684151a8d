// Arrangements of panels: the first one, whether a stored one can be used, and what counts as a change.

import type { DockviewApi, SerializedDockview } from "dockview-react";
import { type FirstPlot, firstPlots } from "./firstPlots";
import { NARROW, placeFor } from "./placement";
import { TOOL_NAMES, TOOLS } from "./tools";

const COMPONENTS: string[] = [...TOOL_NAMES, "plot"];
const SIDE_BELOW = 260;
const PLOT = 0.4;
const NARROW_BELOW = 0.5;

// The architecture at the left with the first plots below it; inspector and sliders at the right. On a narrow
// page the architecture is above, and the others share the place below it.
export function arrangeFirst(api: DockviewApi): void {
  api.clear();
  api.addPanel({ id: "graph", component: "graph", title: TOOLS.graph.title });
  const plots = firstPlots();
  if (api.width > 0 && api.width < NARROW) {
    arrangeNarrow(api, plots);
  } else {
    arrangeWide(api, plots);
  }
  api.getPanel(plots[0]?.id ?? "")?.api.setActive();
  api.getPanel("graph")?.api.setActive();
}

function arrangeNarrow(api: DockviewApi, plots: FirstPlot[]): void {
  const below = { referencePanel: "graph", direction: "below" } as const;
  const within = { referencePanel: "inspector", direction: "within" } as const;
  api.addPanel({
    id: "inspector",
    component: "inspector",
    title: TOOLS.inspector.title,
    position: below,
    initialHeight: Math.round(NARROW_BELOW * api.height),
  });
  api.addPanel({ id: "pins", component: "pins", title: TOOLS.pins.title, position: within });
  for (const plot of plots) {
    api.addPanel({ ...plot, position: within });
  }
}

function arrangeWide(api: DockviewApi, plots: FirstPlot[]): void {
  api.addPanel({
    id: "inspector",
    component: "inspector",
    title: TOOLS.inspector.title,
    position: { direction: "right" },
    initialWidth: TOOLS.inspector.width,
  });
  api.addPanel({
    id: "pins",
    component: "pins",
    title: TOOLS.pins.title,
    position: { referencePanel: "inspector", direction: "below" },
    initialHeight: SIDE_BELOW,
  });
  const [first, ...others] = plots;
  if (first !== undefined) {
    api.addPanel({
      ...first,
      position: { referencePanel: "graph", direction: "below" },
      initialHeight: Math.round(PLOT * api.height),
    });
  }
  for (const plot of others) {
    const position = placeFor(api);
    api.addPanel({ ...plot, ...(position === null ? {} : { position }) });
  }
}

// The arrangement stored in the document, or the default if it is missing or invalid.
export function restore(api: DockviewApi, stored: unknown): void {
  if (isArrangement(stored)) {
    try {
      api.fromJSON(stored);
      if (api.totalPanels > 0) {
        return;
      }
    } catch {
      // A document may contain any data; the default arrangement replaces invalid ones.
    }
  }
  arrangeFirst(api);
}

export function isArrangement(stored: unknown): stored is SerializedDockview {
  if (!isRecord(stored) || !isRecord(stored["grid"]) || !isRecord(stored["panels"])) {
    return false;
  }
  return Object.entries(stored["panels"]).every(
    ([id, panel]) =>
      isRecord(panel) && panel["id"] === id && COMPONENTS.includes(panel["contentComponent"] as string),
  );
}

// What an arrangement is, apart from the size of the window, where the focus is, and titles, which follow
// from the document. Without `sized` the sizes of the panels do not count either.
export function signature(arrangement: SerializedDockview, sized = true): string {
  const panels = Object.entries(arrangement.panels).map(([id, { contentComponent, params }]) => [
    id,
    contentComponent,
    params,
  ]);
  return JSON.stringify({
    ...arrangement,
    panels,
    grid: shares(arrangement.grid.root, sized),
    activeGroup: null,
  });
}

// The arrangement that is stored, or that was found when the page was opened.
export type ArrangementFound = { width: number; height: number; all: string; order: string };

export function found(api: DockviewApi): ArrangementFound {
  const arrangement = api.toJSON();
  const { width, height } = api;
  return { width, height, all: signature(arrangement), order: signature(arrangement, false) };
}

// Whether a person changed the arrangement: another size of the window gives panels other shares, too.
export function isChanged(before: ArrangementFound, now: ArrangementFound): boolean {
  const resized = before.width !== now.width || before.height !== now.height;
  return resized ? before.order !== now.order : before.all !== now.all;
}

type PanelBranch = { type: string; data: unknown; size?: number };

// Sizes in percent of their container; without them what is in it.
function shares(node: PanelBranch, sized: boolean): unknown {
  if (!Array.isArray(node.data)) {
    return node.data;
  }
  const children = node.data as PanelBranch[];
  const all = children.reduce((sum, child) => sum + (child.size ?? 0), 0) || 1;
  return children.map((child) => [
    sized ? Math.round((50 * (child.size ?? 0)) / all) : 0,
    shares(child, sized),
  ]);
}

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}
