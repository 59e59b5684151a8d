// The ports of elements and their axes, as plots read them.

import type { AxisView, DocumentView, ElementView, Kind, PlotView } from "../../protocol";

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

// Positions of the samples; of fewer values than samples, the middles of equal parts of the axis
// (src/deodar_studio/streams/stream.py).
export function points(axis: AxisView, values = axis.samples): Float64Array {
  const [first, last] = edges(axis);
  const step = (last - first) / values;
  return Float64Array.from({ length: values }, (_, i) =>
    values === axis.samples ? axis.lower + i * stepOf(axis) : first + (i + 0.5) * step,
  );
}

// From the outer edge of the cell of the first sample to that of the last.
export function edges(axis: AxisView): [number, number] {
  const step = stepOf(axis);
  const last = axis.lower + (axis.samples - 1) * step;
  return [axis.lower - step / 2, last + step / 2];
}

export function stepOf(axis: AxisView): number {
  const steps = axis.periodic ? axis.samples : axis.samples - 1;
  return steps > 0 ? (axis.upper - axis.lower) / steps : axis.upper - axis.lower;
}

// Which of `count` equal parts of an axis a position is in.
export function cell(axis: AxisView, count: number, position: number): number {
  const [first, last] = edges(axis);
  return Math.min(count - 1, Math.max(0, Math.floor(((position - first) / (last - first)) * count)));
}

// The largest ratio of two axes with the same scale: a longer plot would be a mere strip.
const LONGEST = 8;

// The extents of two axes that have the same scale because they share a unit; null: they do not. A periodic
// axis, such as an angle, has no scale in common with one that is not periodic. Axes without a unit have the
// same scale where their samples are at the same distance.
export function commonScale(x: AxisView, y: AxisView): [number, number] | null {
  const same = x.unit === y.unit && x.periodic === y.periodic;
  const near = Math.abs(stepOf(x) - stepOf(y)) < 1e-6 * stepOf(x);
  const extents = [x, y].map((axis) => edges(axis)[1] - edges(axis)[0]) as [number, number];
  const ratio = extents[0] / extents[1];
  return same && (x.unit !== "" || near) && ratio < LONGEST && 1 / ratio < LONGEST ? extents : null;
}

export function axisLabel(axis: AxisView): string {
  return axis.unit === "" ? axis.name : `${axis.name} (${axis.unit})`;
}

// Whether two axes are the same dimension; axes that were thinned end a little earlier.
export function sameDimension(one: AxisView, other: AxisView): boolean {
  const near = 0.1 * (one.upper - one.lower);
  return (
    one.name === other.name &&
    one.unit === other.unit &&
    Math.abs(one.lower - other.lower) < near &&
    Math.abs(one.upper - other.upper) < near
  );
}
