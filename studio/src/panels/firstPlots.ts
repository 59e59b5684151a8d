// The plots of a document that stores no arrangement of panels: those that its layout lists, or one of the
// first field.

import { firstToPlot, mainPort, portAxes, portsOf } from "../model/ports";
import { plotKinds } from "../plots/kinds/plots";
import type { DocumentView, ElementView } from "../protocol";
import { useStudio } from "../store";
import { plotTitle } from "./openPlot";

export type FirstPlot = { id: string; component: string; title: string; params: object };

type ListedPlot = { element: ElementView; port: string };

export function firstPlots(): FirstPlot[] {
  const { document, kinds } = useStudio.getState();
  if (document === null) {
    return [];
  }
  const listed = listedPlots(document);
  const first = firstToPlot(document, kinds);
  const shown =
    listed.length > 0 || first === null
      ? listed
      : [{ element: first, port: mainPort(first, kinds.get(first.kind)) }];
  return shown.map(({ element, port }, i) => {
    const kind = plotKinds(portAxes(document, element, port))[0] ?? "course";
    return {
      id: `plot-${i + 1}`,
      component: "plot",
      title: plotTitle({ element: element.id, kind }),
      params: { element: element.id, kind, port, settings: {} },
    };
  });
}

// The valid entries of the plots in the layout, `[{ element, port }]`; others are omitted.
export function listedPlots(document: DocumentView): ListedPlot[] {
  const kept = document.layout["plots"];
  return (Array.isArray(kept) ? (kept as unknown[]) : []).flatMap((entry) => {
    const { element: id, port } = (entry ?? {}) as Record<string, unknown>;
    const element = document.elements.find((one) => one.id === id);
    return element !== undefined && typeof port === "string" && portsOf(element).includes(port)
      ? [{ element, port }]
      : [];
  });
}
