// Axes that elements are made with.

import type { AxisView, DocumentView } from "../protocol";

export type AxisProperties = Omit<AxisView, "key">;

const NAMES = ["x", "y", "z", "w"];
// Of axes of elements over one, two, three dimensions: a step of them costs about the same.
const SAMPLES = [101, 51, 21];

// An axis with a name that no other one has, for an element over a number of axes.
export function newAxis(axes: readonly { name: string }[], dimensions = 1): AxisProperties {
  const taken = new Set(axes.map(({ name }) => name));
  const samples = SAMPLES[Math.min(dimensions, SAMPLES.length) - 1] ?? 101;
  let name = NAMES.find((free) => !taken.has(free)) ?? "";
  for (let n = 1; name === ""; n++) {
    name = taken.has(`x${n}`) ? "" : `x${n}`;
  }
  return { name, lower: 0, upper: 100, samples, periodic: false, unit: "" };
}

// The axes of a new element over a number of dimensions, by their keys or properties: those of an element
// over as many, else those that the document has, and new ones.
export function axesOver(
  dimensions: number,
  { axes, elements }: Pick<DocumentView, "axes" | "elements">,
): (string | AxisProperties)[] {
  const listed = elements
    .map(({ values }) => (Array.isArray(values["axes"]) ? (values["axes"] as string[]) : []))
    .filter((keys) => !keys.includes("channel"));
  const same = listed.find((keys) => keys.length === dimensions);
  if (same !== undefined) {
    return same;
  }
  const spare = axes.filter(({ key }) => key !== "channel").map(({ key }) => key);
  const longest = listed.reduce((most, keys) => (keys.length > most.length ? keys : most), [] as string[]);
  const chosen: (string | AxisProperties)[] = [...(longest.length > 0 ? longest : spare)].slice(
    0,
    dimensions,
  );
  const known: { name: string }[] = [...axes];
  while (chosen.length < dimensions) {
    const added = newAxis(known, dimensions);
    known.push(added);
    chosen.push(added);
  }
  return chosen;
}
