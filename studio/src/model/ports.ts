// The ports of elements and their axes, as plots read them.

import type { AxisView, DocumentView, ElementView, Kind, PlotView } from "../protocol";
import { sameDimension } from "../draw/axis";

// A plot of the page, or the name of one of an installed package.
export type PlotKind = string;

const CHANNELS = 3;

// The axes at a port; null where they are not known.
export function portAxes(document: DocumentView, element: ElementView, port: string): AxisView[] | null {
  const keys = element.axes[port];
  const found = keys?.map((key) => document.axes.find((axis) => axis.key === key));
  return found === undefined || found.includes(undefined) ? null : (found as AxisView[]);
}

// Whether a plot of a package can show an array over these axes.
export function fits(plot: PlotView, axes: AxisView[]): boolean {
  const drawn = isPicture(axes) ? 3 : Math.min(axes.length, 2);
  return plot.axes === drawn && (!plot.periodic || axes.every((axis) => axis.periodic));
}

export function isPicture(axes: AxisView[]): boolean {
  const last = axes[2];
  return axes.length === 3 && last?.name === "channel" && last.samples === CHANNELS;
}

export type WeightsView = { name: string; ports: string[] };

// The array parameters of an element from a source to a target, with the ports whose axes their dimensions
// have; those over at least two axes.
export function weightsOf(
  document: DocumentView,
  element: ElementView,
  kind: Kind | undefined,
): WeightsView[] {
  return Object.entries(kind?.maps ?? {}).flatMap(([name, ports]) => {
    const axes = ports.flatMap((port) => portAxes(document, element, port) ?? []);
    return axes.length < 2 ? [] : [{ name, ports }];
  });
}

// Every port of an element, outputs before inputs.
export function portsOf(element: ElementView): string[] {
  return [...new Set([...element.outputs, ...element.inputs])];
}

// The ports that can be drawn into one plot with a port: those over the same axes.
export function portsAlike(element: ElementView, port: string): string[] {
  const keys = JSON.stringify(element.axes[port]);
  return portsOf(element).filter(
    (other) => other === port || (keys !== undefined && JSON.stringify(element.axes[other]) === keys),
  );
}

// The elements that have this port over the same axes, itself among them.
export function elementsAlike(document: DocumentView, element: ElementView, port: string): ElementView[] {
  const keys = JSON.stringify(element.axes[port]);
  return document.elements.filter(
    (other) => other.id === element.id || (keys !== undefined && JSON.stringify(other.axes[port]) === keys),
  );
}

// The most informative port of an element: one with levels, or else its first.
export function mainPort(element: ElementView, kind: Kind | undefined): string {
  const ports = portsOf(element);
  return (
    ports.find((port) => hasLevels(kind, port)) ??
    ports.find((port) => port === "activation") ??
    ports[0] ??
    ""
  );
}

export function hasLevels(kind: Kind | undefined, port: string): boolean {
  return Object.keys(kind?.levels[port] ?? {}).length > 0;
}

// The element to plot first: one whose main port has levels, with the most axes up to two; the first of its
// like. Null if there is none.
export function firstToPlot(document: DocumentView, kinds: Map<string, Kind>): ElementView | null {
  let best: ElementView | null = null;
  let most = -1;
  for (const element of document.elements) {
    const kind = kinds.get(element.kind);
    const port = mainPort(element, kind);
    const axes = portAxes(document, element, port)?.length ?? 0;
    if ((hasLevels(kind, port) || port === "activation") && axes <= 2 && axes > most) {
      best = element;
      most = axes;
    }
  }
  return best;
}

// Whether an axis runs downwards on the screen: it is the second one of a picture somewhere in the document,
// whose rows count from the top.
export function runsDown(document: DocumentView, axis: AxisView): boolean {
  return document.elements.some((element) =>
    portsOf(element).some((port) => {
      const axes = portAxes(document, element, port);
      const rows = axes?.[1];
      return axes !== null && isPicture(axes) && rows !== undefined && sameDimension(rows, axis);
    }),
  );
}
