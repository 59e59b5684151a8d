// The axes that a plot does not draw: a slider for the position on each, or the maximum over it.

import { Slider, UnstyledButton } from "@mantine/core";
import { useOffline } from "../../widgets/NeedsServer";
import type { AxisView } from "../../protocol";
import { stepOf } from "../../draw/axis";
import { reading } from "../../draw/text";
import { ends, middle, moved, sampleAt } from "../../model/section";

type Strip = {
  rest: AxisView[];
  at: Record<string, number>;
  set: (settings: { at: Record<string, number> }) => void;
};

export function SectionStrip({ rest, at, set }: Strip) {
  const off = useOffline();
  if (rest.length === 0) {
    return null;
  }
  return (
    <div className="plot-strip">
      {rest.map((axis) => {
        const position = at[axis.name];
        const shown = sampleAt(axis, position ?? middle(axis));
        const [min, max] = ends(axis);
        return (
          <div key={axis.name} className="flow plot-cut">
            <span className="plot-cut-name">{axis.name}</span>
            <UnstyledButton
              className="plot-chip"
              aria-label={`max over ${axis.name}`}
              aria-pressed={position === undefined}
              onClick={() => set({ at: moved(at, axis.name, position === undefined ? shown : null) })}
            >
              max
            </UnstyledButton>
            <Slider
              className="plot-cut-slider"
              data-off={position === undefined || undefined}
              disabled={off}
              size={4}
              thumbSize={12}
              label={null}
              thumbLabel={`Position on ${axis.name}`}
              thumbValueText={() => (position === undefined ? "maximum" : withUnit(shown, axis))}
              min={min}
              max={max}
              step={stepOf(axis)}
              value={shown}
              onChange={(value) => set({ at: moved(at, axis.name, sampleAt(axis, value)) })}
            />
            <span className="plot-cut-value dim numbers">
              {position === undefined ? "" : withUnit(shown, axis)}
            </span>
          </div>
        );
      })}
    </div>
  );
}

function withUnit(value: number, { unit }: AxisView): string {
  return `${reading(value)} ${unit}`.trim();
}
