// The plots that a document opens with: its tiles, else those of the panels that earlier versions stored,
// else those that its layout lists, else one of the first field.

import { firstToPlot, mainPort, portAxes, portsOf } from "../model/ports";
import { plotKinds } from "../plots/kinds/plots";
import { type PlotParams, readParams } from "../plots/settings";
import type { DocumentView, ElementView, Kind } from "../protocol";
import { VIEWS } from "../state/page";
import type { PlotLists } from "../state/tiles";

export function firstTiles(document: DocumentView, kinds: ReadonlyMap<string, Kind>): PlotLists {
  return tilesOf(document.layout) ?? { build: firstPlots(document, kinds) };
}

// The plots that a layout states; null: none.
export function tilesOf({ tiles, panels }: DocumentView["layout"]): PlotLists | null {
  return storedTiles(tiles) ?? panelPlots(panels);
}

function storedTiles(stored: unknown): PlotLists | null {
  if (!isRecord(stored)) {
    return null;
  }
  const lists = VIEWS.flatMap((view) => {
    const list = stored[view];
    return Array.isArray(list) ? [[view, plotsOf(list)] as const] : [];
  });
  return lists.length === 0 ? null : Object.fromEntries(lists);
}

// The plots among panels that were arranged by hand, in the order in which they were opened.
function panelPlots(stored: unknown): PlotLists | null {
  if (!isRecord(stored) || !isRecord(stored["grid"]) || !isRecord(stored["panels"])) {
    return null;
  }
  const panels = Object.values(stored["panels"]);
  return {
    build: plotsOf(
      panels.flatMap((panel) =>
        isRecord(panel) && panel["contentComponent"] === "plot" ? [panel["params"]] : [],
      ),
    ),
  };
}

const plotsOf = (stored: unknown[]): PlotParams[] =>
  stored.flatMap((params) =>
    isRecord(params) && typeof params["element"] === "string" ? [readParams(params)] : [],
  );

function firstPlots(document: DocumentView, kinds: ReadonlyMap<string, Kind>): PlotParams[] {
  const listed = listedPlots(document);
  const first = firstToPlot(document, new Map(kinds));
  const shown =
    listed.length > 0 || first === null
      ? listed
      : [{ element: first, port: mainPort(first, kinds.get(first.kind)) }];
  return shown.map(({ element, port }) => ({
    element: element.id,
    kind: plotKinds(portAxes(document, element, port))[0] ?? "course",
    port,
    settings: {},
  }));
}

// The valid entries of the plots in the layout, `[{ element, port }]`; others are omitted.
export function listedPlots(document: DocumentView): { element: ElementView; port: string }[] {
  const kept = document.layout["plots"];
  return (Array.isArray(kept) ? (kept as unknown[]) : []).flatMap((entry) => {
    const { element: id, port } = (entry ?? {}) as Record<string, unknown>;
    const element = document.elements.find((one) => one.id === id);
    return element !== undefined && typeof port === "string" && portsOf(element).includes(port)
      ? [{ element, port }]
      : [];
  });
}

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}
