// The plots that a document opens with: its tiles, else those that its layout lists, else one of the first
// field.

import { firstToPlot, mainPort, portAxes, portsOf } from "../model/ports";
import { plotKinds } from "../plots/kinds/plots";
import type { PlotParams } from "../model/settings";
import type { DocumentView, ElementView, Kind } from "../protocol";
import type { PlotLists } from "../state/tiles";

export function firstTiles(document: DocumentView, kinds: ReadonlyMap<string, Kind>): PlotLists {
  return document.layout.tiles ?? { build: firstPlots(document, kinds) };
}

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

// The ports that the layout names for plots, as far as the document has them.
export function listedPlots({ layout, elements }: DocumentView): { element: ElementView; port: string }[] {
  return layout.plots.flatMap(({ element: id, port }) => {
    const element = elements.find((one) => one.id === id);
    return element !== undefined && portsOf(element).includes(port) ? [{ element, port }] : [];
  });
}
