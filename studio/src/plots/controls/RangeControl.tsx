// The range of values of a plot: it follows the data or is fixed.

import { Switch } from "@mantine/core";

import type { Range } from "../../draw/scale";
import { NumberField } from "../../widgets/NumberField";

export function RangeControl({
  range,
  shown,
  set,
}: {
  range: Range | null;
  shown: () => Range;
  set: (range: Range | null) => void;
}) {
  const change = (next: Range) => {
    if (next[0] < next[1]) {
      set(next);
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
          <NumberField
            label="Lowest value"
            value={range[0]}
            upper={range[1]}
            set={(value) => change([value, range[1]])}
          />
          <NumberField
            label="Highest value"
            value={range[1]}
            lower={range[0]}
            set={(value) => change([range[0], value])}
          />
        </div>
      )}
    </>
  );
}
