// A slider and a number beside it, which is dragged sideways, and typed after a click: one number of an
// element, or a document parameter.

import { type ReactNode, useRef, useState } from "react";

import type { ListedProblem } from "../protocol";
import { numberText } from "../model/number";
import { NumberBox } from "../widgets/NumberBox";
import { ProblemLine } from "../widgets/ProblemLine";
import { type SliderRange, dragged, finer, including, nudged, snapped } from "../model/sliderRange";
import type { Setting } from "../actions/setting";
import { ValueSlider } from "./ValueSlider";
import { useOffline } from "../widgets/NeedsServer";
import { usePull } from "../widgets/usePull";

type NumberControlProps = {
  label: string;
  setting: Setting<number | null>;
  // What is sensible now; a range that was shown before stays as long as it holds the value.
  range: SliderRange;
  // Another key is another range.
  rangeKey: string;
  unit: string;
  optional?: boolean;
  // Shows the ends of the range; a double click on one asks for others.
  onRange?: () => void;
};

export function NumberControl(props: NumberControlProps) {
  const { label, setting, range, rangeKey, unit, optional = false, onRange } = props;
  const { value, problem, commit, move, end, nudge, forget } = setting;
  const [complaint, setComplaint] = useState<ListedProblem | null>(null);
  const shown = useCalmRange(range, rangeKey, value);
  const wrong = complaint ?? problem;
  const onForget = () => {
    setComplaint(null);
    forget();
  };

  const slider =
    value === null ? (
      <span className="dim grow">none</span>
    ) : (
      <ValueSlider label={label} value={value} range={shown} onMove={move} onEnd={end} onNudge={nudge} />
    );

  const rangeEnd = (value: number) => (
    <span className="range-end" title="Double-click to change the range" onDoubleClick={onRange}>
      {endText(value, shown)}
    </span>
  );
  return (
    <div className={onRange === undefined ? "number-control" : "number-control number-control-ranged"}>
      {onRange === undefined ? (
        slider
      ) : (
        <div className="ranged-slider">
          {rangeEnd(shown.lower)}
          {slider}
          {rangeEnd(shown.upper)}
        </div>
      )}
      <NumberDrag value={value} range={shown} onMove={move} onEnd={end}>
        <NumberBox
          label={label}
          value={value}
          unit={unit}
          optional={optional}
          placeholder={optional ? "none" : undefined}
          rejected={wrong !== null}
          onCommit={commit}
          onStep={
            value === null
              ? undefined
              : (direction, coarse) => nudge(nudged(value, direction, coarse, including(shown, value)))
          }
          onForget={onForget}
          onComplain={setComplaint}
          onLeave={end}
        />
      </NumberDrag>
      <ProblemLine problem={wrong} />
    </div>
  );
}

// An end for display, rounded to the step.
function endText(end: number, { step, logarithmic }: SliderRange): string {
  return numberText(logarithmic ? end : Math.round(end / step) * step);
}

// Ranges follow from values, but must not move under the hand: the first one stays, and grows where a value
// lies outside.
function useCalmRange(range: SliderRange, key: string, value: number | null): SliderRange {
  const kept = useRef({ key, range });
  if (kept.current.key !== key) {
    kept.current = { key, range };
  }
  if (value !== null) {
    kept.current.range = including(kept.current.range, value);
  }
  return kept.current.range;
}

type NumberDragProps = {
  value: number | null;
  range: SliderRange;
  onMove: (value: number) => void;
  onEnd: () => void;
  children: ReactNode;
};

const isFocused = (target: EventTarget): boolean => target === document.activeElement;

function NumberDrag({ value, range, onMove, onEnd, children }: NumberDragProps) {
  const offline = useOffline();
  const { isPressed, handlers } = usePull({
    begin: ({ target }) => (offline || isFocused(target) ? null : value),
    isFree: () => true,
    pulled: (at, pixels, { shiftKey }) => dragged(at, pixels, shiftKey, range),
    move: (at, { shiftKey }) => onMove(snapped(at, shiftKey ? finer(range) : range)),
    end: onEnd,
    click: ({ currentTarget }) => currentTarget.querySelector("input")?.focus(),
  });
  return (
    <div
      className={value === null ? undefined : "number-drag"}
      {...handlers}
      onMouseDown={(event) => isPressed() && event.preventDefault()}
    >
      {children}
    </div>
  );
}
