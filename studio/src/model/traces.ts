// What a time course shows, and how much of it.

import type { AxisView } from "../protocol";
import type { TraceSetting } from "./settings";

// What a time course shows, in words; the path names its element where that is not clear.
export function traceLabel({ port, reduce, at }: TraceSetting, path: string): string {
  const name = `${path} ${port}`.trim();
  return reduce === "at" ? (at.length === 0 ? name : `${name} at ${at.join(", ")}`) : `${reduce} of ${name}`;
}

// The times that are shown: the newest `window` time units, or all. While less than that has passed, the axis
// is at rest. A moment of the past is in the middle of the window, as far as the samples reach.
export function timeRange(
  first: number,
  last: number,
  window: number | null,
  moment: number | null = null,
): [number, number] {
  if (window === null) {
    return last > first ? [first, last] : [first, first + 1];
  }
  if (last - first <= window) {
    return [first, first + window];
  }
  const end = moment === null ? last : Math.min(last, Math.max(first + window, moment + window / 2));
  return [end - window, end];
}

// A time course of a port over these axes; a position is the middle at first.
export function traceOf(
  element: string,
  port: string,
  axes: AxisView[],
  reduce: TraceSetting["reduce"],
): TraceSetting {
  if (axes.length === 0) {
    return { element, port, reduce: "at", at: [] };
  }
  const at = reduce === "at" ? axes.map(({ lower, upper }) => (lower + upper) / 2) : [];
  return { element, port, reduce, at };
}
