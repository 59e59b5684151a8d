// A measured regime as the content of a plot: settled activation over the strength of an input.

import type { Content } from "../draw/content";
import { extent, round } from "../draw/scale";
import { LEVEL, line, portPaint } from "../plots/kinds/parts";
import type { RegimeCurve } from "../protocol";

// Both branches, which part where the field is bistable; a value that is missing leaves a gap.
export function curveContent({ input, up, down, threshold }: RegimeCurve): Content {
  const known = (values: readonly (number | null)[]) => values.map((value) => value ?? Number.NaN);
  const range = round(extent([...known(up), ...known(down), threshold]) ?? [0, 1]);
  const [first = 0, last = 1] = [input[0], input.at(-1)];
  return {
    x: {
      along: null,
      label: "strength of a localised input",
      range: [first, last > first ? last : first + 1],
    },
    y: { along: null, range },
    marks: [
      { type: "level", label: "threshold", value: threshold, color: LEVEL },
      { ...line("input falls", portPaint("input", []), input, known(down)), width: 2, dashed: true },
      { ...line("input grows", portPaint("activation", []), input, known(up)), width: 2 },
    ],
  };
}
