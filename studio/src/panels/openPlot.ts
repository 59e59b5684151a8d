// Adding panels to the dock from anywhere: the dock passes on its interface when it is ready.

import type { DockviewApi, IDockviewPanel } from "dockview-react";
import { mainPort, type PlotKind, portAxes, portsOf } from "../model/ports";
import { plotKinds, tabOf } from "../plots/kinds/plots";
import { readParams, readSettings } from "../plots/settings";
import { shownPorts } from "../plots/shownPorts";
import type { RecordedPort } from "../protocol";
import { useStudio } from "../store";
import { NARROW, placeFor, reportGroup } from "./placement";
import { Remembered } from "./remembered";
import { TOOLS, type Tool } from "./tools";

export type PlotWish = { element: string; kind?: PlotKind; port?: string };

let dock: DockviewApi | null = null;
let remembered: Remembered | null = null;

export function setDock(api: DockviewApi | null): void {
  remembered?.end();
  dock = api;
  remembered = api === null ? null : new Remembered(api);
}

// Another document has its own arrangement.
export function forgetArrangements(): void {
  remembered?.forget();
}

// Show a plot: the one that is there, or else a new one.
export function openPlot(wish: PlotWish): void {
  if (dock === null) {
    return;
  }
  const plot = plotFor(wish);
  const there = dock.panels.find((panel) => isPlot(panel) && isSame(panel, plot));
  if (there !== undefined) {
    there.api.setActive();
    return;
  }
  const position = placeFor(dock);
  remembered?.add();
  dock.addPanel({
    id: freeId(dock),
    component: "plot",
    title: plotTitle(plot),
    params: { ...plot, settings: {} },
    ...(position === null ? {} : { position }),
  });
}

// The ports that all plots show.
export function plottedPorts(): RecordedPort[] {
  const { document, elements, kinds } = useStudio.getState();
  const ports = new Map<string, RecordedPort>();
  for (const panel of dock?.panels ?? []) {
    const { element, port, kind, settings } = readParams(panel.params ?? {});
    const found = elements.get(element);
    if (document !== null && isPlot(panel) && found !== undefined) {
      const type = kinds.get(found.kind);
      const main = portsOf(found).includes(port) ? port : mainPort(found, type);
      const plot = { kind: kind ?? plotKinds(portAxes(document, found, main))[0] ?? "course", port: main };
      for (const one of shownPorts(document, found, type, plot, readSettings(settings))) {
        ports.set(`${one.element} ${one.port}`, one);
      }
    }
  }
  return [...ports.values()];
}

// Show one of the panels that exist once.
export function openTool(tool: Tool): void {
  if (dock === null) {
    return;
  }
  const there = dock.getPanel(tool);
  if (there !== undefined) {
    there.api.setActive();
    return;
  }
  const { title, direction, width } = TOOLS[tool];
  const group = tool === "report" ? reportGroup(dock) : null;
  remembered?.add();
  const panel = { id: tool, component: tool, title };
  if (group === null) {
    dock.addPanel({ ...panel, position: { direction }, initialWidth: width });
  } else {
    dock.addPanel({ ...panel, position: { referenceGroup: group, direction: "within" } });
  }
}

// Whether a panel that exists once can be seen.
export function isShown(tool: Tool): boolean {
  return dock?.getPanel(tool)?.api.isVisible === true;
}

// Show the world of a document that was just opened: beside its first plot, so that the architecture keeps
// its place.
export function openFirstWorld(): void {
  const plot = dock?.getPanel("plot-1");
  if (dock === null || plot === undefined || dock.getPanel("world") !== undefined) {
    openTool("world");
    return;
  }
  const direction = dock.width < NARROW ? "within" : "right";
  remembered?.add();
  dock.addPanel({
    id: "world",
    component: "world",
    title: TOOLS.world.title,
    position: { referencePanel: plot, direction },
    inactive: direction === "within",
  });
}

export function plotTitle({ element, kind }: { element: string; kind: PlotKind | null }): string {
  const found = useStudio.getState().elements.get(element);
  return found === undefined ? "Plot" : tabOf(kind, found.name);
}

type Plot = { element: string; kind: PlotKind; port: string };

function plotFor({ element, kind, port }: PlotWish): Plot {
  const { document, elements, kinds } = useStudio.getState();
  const found = elements.get(element);
  const shown = port ?? (found === undefined ? "" : mainPort(found, kinds.get(found.kind)));
  const axes = document === null || found === undefined ? null : portAxes(document, found, shown);
  return { element, kind: kind ?? plotKinds(axes)[0] ?? "course", port: shown };
}

function isPlot(panel: IDockviewPanel): boolean {
  return panel.api.component === "plot";
}

function isSame(panel: IDockviewPanel, plot: Plot): boolean {
  const params = readParams(panel.params ?? {});
  return (
    params.element === plot.element &&
    params.kind === plot.kind &&
    (params.port === plot.port || plot.kind === "curve")
  );
}

function freeId(api: DockviewApi): string {
  for (let n = 1; ; n++) {
    if (api.getPanel(`plot-${n}`) === undefined) {
      return `plot-${n}`;
    }
  }
}
