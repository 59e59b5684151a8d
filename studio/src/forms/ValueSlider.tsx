// A slider for one number. Arrow keys are fine steps, with Shift coarse ones; Home and End go to the ends.

import { Slider } from "@mantine/core";
import type { KeyboardEvent } from "react";

import { useOffline } from "../widgets/NeedsServer";
import { numberText } from "../model/number";
import { nudged, snapped, type SliderRange } from "../model/sliderRange";

type ValueSliderProps = {
  label: string;
  value: number;
  range: SliderRange;
  disabled?: boolean;
  onMove: (value: number) => void;
  onEnd: () => void;
  onNudge: (value: number) => void;
};

const UP = ["ArrowRight", "ArrowUp", "PageUp"];
const DOWN = ["ArrowLeft", "ArrowDown", "PageDown"];
// Fine enough for the slider to follow the pointer; values are rounded afterwards.
const FINE = 1e4;

export function ValueSlider({ label, value, range, disabled, onMove, onEnd, onNudge }: ValueSliderProps) {
  const offline = useOffline();
  const fixed = disabled === true || offline;
  const { lower, upper, logarithmic } = range;
  const at = (v: number) => (logarithmic ? Math.log10(Math.max(v, lower)) : v);
  const from = (position: number) => (logarithmic ? 10 ** position : position);
  const [min, max] = [at(lower), at(upper)];
  const inside = Math.min(upper, Math.max(lower, value));

  const onKeyDown = (event: KeyboardEvent) => {
    const coarse = event.shiftKey || event.key.startsWith("Page");
    const next = UP.includes(event.key)
      ? nudged(inside, 1, coarse, range)
      : DOWN.includes(event.key)
        ? nudged(inside, -1, coarse, range)
        : event.key === "Home"
          ? lower
          : event.key === "End"
            ? upper
            : null;
    if (next !== null && !event.ctrlKey && !event.metaKey && !event.altKey) {
      event.preventDefault();
      event.stopPropagation();
      if (!fixed) {
        onNudge(next);
      }
    }
  };

  return (
    <div className="value-slider" onKeyDownCapture={onKeyDown}>
      <Slider
        size={4}
        thumbSize={12}
        label={null}
        thumbLabel={label}
        thumbValueText={() => numberText(value)}
        min={min}
        max={max}
        step={(max - min) / FINE}
        precision={12}
        scale={logarithmic ? from : undefined}
        startPointValue={!logarithmic && lower < 0 && upper > 0 ? 0 : undefined}
        value={at(inside)}
        disabled={fixed}
        onChange={(position) => onMove(snapped(from(position), range))}
        onChangeEnd={onEnd}
      />
    </div>
  );
}
