// The place of a new plot: beside the other plots while there is space, else as a tab.

import type { AddPanelPositionOptions, DockviewApi, DockviewGroupPanel } from "dockview-react";

// A page that is narrower has no room for panels side by side, in px.
export const NARROW = 900;

export type PanelSize = { width: number; height: number };

const WIDE = 640;
const HIGH = 460;

// Divides a box between its content and a new panel.
export function share({ width, height }: PanelSize): "right" | "below" | "within" {
  return width >= WIDE ? "right" : height >= HIGH ? "below" : "within";
}

function largestOfPlots(api: DockviewApi): DockviewGroupPanel | null {
  const plots = api.groups.filter((group) => group.panels.some((panel) => panel.api.component === "plot"));
  return plots.reduce<DockviewGroupPanel | null>(
    (best, group) => (best === null || area(group) > area(best) ? group : best),
    null,
  );
}

export function placeFor(api: DockviewApi): AddPanelPositionOptions | null {
  const largest = largestOfPlots(api);
  if (largest !== null) {
    return { referenceGroup: largest, direction: share(largest) };
  }
  const graph = api.getPanel("graph");
  return graph === undefined ? null : { referencePanel: graph, direction: "below" };
}

// The place of the import report is a tab below the architecture, which its lines lead to: beside the largest
// plot, or the inspector of a narrow page. Null: there is none.
export function reportGroup(api: DockviewApi): DockviewGroupPanel | null {
  const inspector = api.width < NARROW ? api.getPanel("inspector")?.group : undefined;
  const group = largestOfPlots(api) ?? inspector;
  return group === undefined || group === api.getPanel("graph")?.group ? null : group;
}

function area({ width, height }: PanelSize): number {
  return width * height;
}
