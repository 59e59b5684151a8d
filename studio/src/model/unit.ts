// Units as they are declared (time, axis, activation, and products of them) and as they are read.

import type { AxisView } from "../protocol";

// The unit of document time; none for abstract time, and the definition of a step for custom units.
export function timeText(timeUnit: string): string {
  if (timeUnit === "abstract") {
    return "";
  }
  const steps = /^1 = (.+)$/.exec(timeUnit);
  return steps !== null ? `× ${steps[1]}` : timeUnit === "us" ? "µs" : timeUnit;
}

// The unit that all these axes have; none where they differ.
export function axisText(axes: AxisView[]): string {
  const units = new Set(axes.map((axis) => axis.unit));
  return units.size === 1 ? ([...units][0] ?? "") : "";
}

export function unitText(unit: string, timeUnit: string, axes: AxisView[]): string {
  const words: Record<string, string> = {
    time: timeText(timeUnit),
    axis: axisText(axes),
    activation: "",
    "1": "",
  };
  const read = (word: string) => words[word] ?? word;
  const [above = "", ...below] = unit.split("/");
  const numerator = product(above, read);
  const denominator = below.map((part) => product(part, read)).filter((part) => part !== "");
  return denominator.length === 0 ? numerator : [numerator || "1", ...denominator].join("/");
}

function product(text: string, read: (word: string) => string): string {
  return text
    .split(" x ")
    .map((word) => read(word.trim()))
    .filter((word) => word !== "")
    .join(" × ");
}
