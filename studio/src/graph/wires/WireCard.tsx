// Above the number of a selected connection: what it does, and a slider of its strength. Of the size that it
// has at a zoom of 1.

import { useStore } from "@xyflow/react";
import { isEditable } from "../../build/editable";
import { including } from "../../inspector/numbers/sliderRange";
import { ValueSlider } from "../../inspector/numbers/ValueSlider";
import { useStudio } from "../../store";
import type { Chain } from "./chains";
import { RANGE, useStrength, wireText } from "./strength";

export function WireCard({ chain }: { chain: Chain }) {
  const zoom = useStore((state) => state.transform[2]);
  const text = useStudio(({ elements }) => wireText(chain, elements));
  const { value, move, end, nudge } = useStrength(chain);
  return (
    <div
      className="graph-wire-card nodrag nopan"
      style={{ transform: `translateX(-50%) scale(${1 / zoom})` }}
    >
      <span className="one-line">{text}</span>
      <ValueSlider
        label={`Strength, ${text}`}
        value={value}
        range={including(RANGE, value)}
        disabled={!useStudio(isEditable)}
        onMove={move}
        onEnd={end}
        onNudge={nudge}
      />
    </div>
  );
}
