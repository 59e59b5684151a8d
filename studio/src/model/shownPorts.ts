// The ports whose values a plot shows, which a record of what is plotted holds.

import type { DocumentView, ElementView, Kind, RecordedPort } from "../protocol";
import { inOrder } from "./colors";
import { elementsAlike, mainPort, type PlotKind, portsAlike } from "./ports";
import type { PlotSettings } from "./settings";

// The name of the levels among the curves.
export const LEVELS = "levels";

export function shownPorts(
  document: DocumentView,
  element: ElementView,
  type: Kind | undefined,
  { kind, port }: { kind: PlotKind; port: string },
  { shown, traces, across, up }: PlotSettings,
): RecordedPort[] {
  const own = { element: element.id, port };
  switch (kind) {
    case "curve": {
      const ports = inOrder(portsAlike(element, port));
      const curves = shown ?? firstCurves(ports, curveLevel(element, type, port));
      return ports.filter((other) => curves.includes(other)).map((other) => ({ ...own, port: other }));
    }
    case "course":
      return traces.length === 0 ? [own] : traces.map((trace) => portOf(trace));
    case "phase":
      return [across === null ? own : portOf(across), ...(up === null ? [] : [portOf(up)])];
    case "multiples":
      return elementsAlike(document, element, port).map(({ id }) => ({ element: id, port }));
    case "kernel":
    case "weights":
      return [];
    default:
      return [own];
  }
}

// The port among the curves whose levels are lines.
export function curveLevel(element: ElementView, type: Kind | undefined, port: string): string {
  const main = mainPort(element, type);
  return portsAlike(element, port).includes(main) ? main : port;
}

// The curves that a plot shows at first. Of a record, only what was recorded, unless nothing was.
export function firstCurves(ports: string[], level: string, recorded?: string[]): string[] {
  const first = [level, ...ports.filter((port) => port === "output")];
  const there = first.filter((port) => recorded?.includes(port) ?? true);
  return [...new Set([...(there.length > 0 ? there : first), LEVELS])];
}

function portOf({ element, port }: RecordedPort): RecordedPort {
  return { element, port };
}
