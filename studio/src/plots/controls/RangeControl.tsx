// The range of values of a plot: it follows the data or is fixed.

import { NumberInput, Switch } from "@mantine/core";
import type { Range } from "../../draw/scale";

export function RangeControl({
  range,
  shown,
  set,
}: {
  range: Range | null;
  shown: () => Range;
  set: (range: Range | null) => void;
}) {
  const change = (end: 0 | 1, value: number | string) => {
    if (range !== null && typeof value === "number") {
      const next: Range = end === 0 ? [value, range[1]] : [range[0], value];
      if (next[0] < next[1]) {
        set(next);
      }
    }
  };
  return (
    <>
      <Switch
        size="xs"
        label="Range follows the values"
        checked={range === null}
        onChange={(event) => set(event.currentTarget.checked ? null : shown())}
      />
      {range !== null && (
        <div className="plot-pair">
          <NumberInput
            size="xs"
            label="Lowest value"
            value={range[0]}
            onChange={(value) => change(0, value)}
          />
          <NumberInput
            size="xs"
            label="Highest value"
            value={range[1]}
            onChange={(value) => change(1, value)}
          />
        </div>
      )}
    </>
  );
}
