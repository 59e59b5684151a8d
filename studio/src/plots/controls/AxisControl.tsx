// The choice of the axes that are drawn.

import { NativeSelect } from "@mantine/core";
import type { AxisView } from "../../protocol";
import { exchanged } from "../section";

type AxisChoice = {
  // All axes of the array, the drawn ones first.
  axes: AxisView[];
  // What each drawn axis is called, in their order.
  labels: string[];
  set: (settings: { drawn: string[] }) => void;
};

export function AxisControl({ axes, labels, set }: AxisChoice) {
  if (axes.length < 2) {
    return null;
  }
  const names = axes.map(({ name }) => name);
  const drawn = names.slice(0, labels.length);
  return (
    <div className="plot-pair">
      {labels.map((label, place) => (
        <NativeSelect
          key={label}
          size="xs"
          label={label}
          data={[...names].sort()}
          value={drawn[place]}
          onChange={(event) => set({ drawn: exchanged(drawn, place, event.currentTarget.value) })}
        />
      ))}
    </div>
  );
}
