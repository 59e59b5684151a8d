// What is injected where.

import type { Axis } from "../../draw/axis";
import type { DocumentView, ElementView } from "../../protocol";
import { portAxes } from "../../model/ports";

// An input to inject, in units of the axes of the element; null: everywhere.
export type Spot = { center: number[] | null; sigma: number[] | null; amplitude: number };

export type Injection = {
  element: ElementView;
  document: DocumentView;
  // The axes that are drawn, as they were announced: to the right, and upwards if there are two.
  shown: readonly Axis[];
  amplitude: number;
  // sigma as a share of each axis.
  width: number;
  // Positions on axes that are not drawn, by name.
  at?: Record<string, number>;
};

// So wide that it is the same everywhere: for axes that are not drawn.
const FLAT = 100;

// The place on all axes of the element, in its order; axes that are neither drawn nor cut get everything.
export function spot(
  { element, document, shown, amplitude, width, at: cut = {} }: Injection,
  place: number[] | null,
): Spot {
  if (place === null) {
    return { center: null, sigma: null, amplitude };
  }
  const axes =
    element.inputs
      .map((port) => portAxes(document, element, port))
      .find((found) => found !== null && found.length > 0) ?? shown;
  const center: number[] = [];
  const sigma: number[] = [];
  for (const axis of axes) {
    const at = shown.findIndex((other) => other.name === axis.name);
    const range = axis.upper - axis.lower;
    const position = cut[axis.name];
    center.push(
      at < 0
        ? (position ?? (axis.lower + axis.upper) / 2)
        : Math.min(axis.upper, Math.max(axis.lower, place[at] ?? axis.lower)),
    );
    sigma.push(range * (at < 0 && position === undefined ? FLAT : width));
  }
  return { center, sigma, amplitude };
}
