// Opening plots from anywhere.

import { mainPort, type PlotKind, portAxes, portsOf } from "../model/ports";
import { plotKinds } from "../plots/kinds/plots";
import { readSettings } from "../model/settings";
import { shownPorts } from "../model/shownPorts";
import type { RecordedPort } from "../protocol";
import { showView, usePage } from "../state/page";
import { addTile, tilesIn, useTiles } from "../state/tiles";
import { useStudio } from "../server/store";

export type PlotWish = { element: string; kind?: PlotKind; port?: string };

// A page that is narrower shows plots in Run alone.
export const NARROW = "(max-width: 819px)";

// Show a plot: the one that is there, or else a new one.
export function openPlot(wish: PlotWish): void {
  if (usePage.getState().view !== "run" && matchMedia(NARROW).matches) {
    showView("run");
  }
  const plot = plotFor(wish);
  const { view, enlarged } = usePage.getState();
  const there = tilesIn(useTiles.getState(), view).find(
    ({ element, kind, port }) =>
      element === plot.element && kind === plot.kind && (port === plot.port || plot.kind === "curve"),
  );
  const key = there?.key ?? addTile(view, { ...plot, settings: {} });
  if (enlarged !== null && enlarged !== key) {
    usePage.setState({ enlarged: null });
  }
  requestAnimationFrame(() =>
    document.querySelector(`[data-tile="${key}"]`)?.scrollIntoView({ block: "nearest" }),
  );
}

// The ports that all plots of the view show.
export function plottedPorts(): RecordedPort[] {
  const { document, elements, kinds } = useStudio.getState();
  const ports = new Map<string, RecordedPort>();
  for (const { element, port, kind, settings } of tilesIn(useTiles.getState(), usePage.getState().view)) {
    const found = elements.get(element);
    if (document !== null && found !== undefined) {
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

type Plot = { element: string; kind: PlotKind; port: string };

function plotFor({ element, kind, port }: PlotWish): Plot {
  const { document, elements, kinds } = useStudio.getState();
  const found = elements.get(element);
  const shown = port ?? (found === undefined ? "" : mainPort(found, kinds.get(found.kind)));
  const axes = document === null || found === undefined ? null : portAxes(document, found, shown);
  return { element, kind: kind ?? plotKinds(axes)[0] ?? "course", port: shown };
}
