// Sections of arrays: which axes a plot draws, and the positions on the others
// (src/deodar_studio/live/section.py).

import type { Announced, AxisView } from "../protocol";
import { stepOf } from "../draw/axis";

// All axes of the array of a stream: the drawn ones first, then the others.
export function allAxes(form: Announced | null): AxisView[] {
  return form === null ? [] : [...form.axes, ...form.rest];
}

// The section in which an axis is drawn at a place, 0 for the first; it changes places with the axis there.
export function exchanged(drawn: string[], place: number, name: string): string[] {
  const before = drawn[place];
  return drawn.map((other, i) =>
    i === place ? name : other === name && before !== undefined ? before : other,
  );
}

// The section with another position on an axis; null: the maximum over it.
export function moved(
  at: Record<string, number>,
  name: string,
  position: number | null,
): Record<string, number> {
  const { [name]: _, ...others } = at;
  return position === null ? others : { ...others, [name]: position };
}

// The position of the sample that is nearest to a position.
export function sampleAt(axis: AxisView, position: number): number {
  const step = stepOf(axis);
  const number = Math.round((position - axis.lower) / step);
  return axis.lower + Math.min(axis.samples - 1, Math.max(0, number)) * step;
}

// The position on an axis that shows it first: its middle.
export function middle(axis: AxisView): number {
  return sampleAt(axis, (axis.lower + axis.upper) / 2);
}

// The bounds of a slider over the samples.
export function ends(axis: AxisView): [number, number] {
  return [axis.lower, axis.lower + (axis.samples - 1) * stepOf(axis)];
}
