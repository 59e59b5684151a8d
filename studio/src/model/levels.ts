// Levels on the scale of a port (threshold, resting level), as the kind of an element names them, with the
// values they have now.

import type { DocumentView, ElementView, Kind } from "../protocol";
import { valueAt } from "./values";

export type Level = { label: string; value: number };

export function levelsOf(
  document: DocumentView,
  element: ElementView,
  kind: Kind | undefined,
  port: string,
): Level[] {
  const found: Level[] = [];
  for (const [label, parameter] of Object.entries(kind?.levels[port] ?? {})) {
    const driver = document.parameters.find((k) =>
      k.links.some((link) => link.element === element.id && link.parameter === parameter),
    );
    const value = driver?.value ?? valueAt(element.values, parameter);
    if (typeof value === "number" && Number.isFinite(value)) {
      found.push({ label, value });
    }
  }
  return found;
}

// The level around which colours turn: the threshold, if there is one.
export function thresholdOf(levels: readonly Level[]): number | null {
  return levels.find((level) => level.label === "threshold")?.value ?? null;
}

// An input that carries a field well over its threshold, as a first guess.
export function pushAmplitude(levels: Level[]): number {
  const values = levels.map((level) => level.value);
  const distance = values.length > 1 ? Math.max(...values) - Math.min(...values) : 0;
  return distance > 0 ? Number((2 * distance).toPrecision(2)) : 5;
}
