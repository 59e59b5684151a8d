// Above the number of a selected connection: what it does, and a slider of its strength, or why it has none.
// Of the size that it has at a zoom of 1.

import { useStore } from "@xyflow/react";
import { whyFixed } from "../../state/editable";
import { including } from "../../model/sliderRange";
import { ValueSlider } from "../../forms/ValueSlider";
import { useStudio } from "../../server/store";
import type { Chain } from "../../architecture/chains";
import { RANGE, useStrength, wireText } from "../../actions/strength";

// `count`: the connections that are drawn as one.
export function WireCard({ chain, count }: { chain: Chain | undefined; count: number }) {
  const zoom = useStore((state) => state.transform[2]);
  return (
    <div
      className="graph-wire-card nodrag nopan"
      style={{ transform: `translateX(-50%) scale(${1 / zoom})` }}
    >
      {chain !== undefined ? (
        <WireSlider chain={chain} />
      ) : (
        <span>
          {count > 1
            ? `${count} connections, each with a strength of its own: open the group to change it.`
            : "Several couplings, each with a number of its own."}
        </span>
      )}
    </div>
  );
}

function WireSlider({ chain }: { chain: Chain }) {
  const text = useStudio(({ elements }) => wireText(chain, elements));
  const why = useStudio(whyFixed);
  const { value, move, end, nudge } = useStrength(chain);
  return (
    <>
      <span className="one-line">{text}</span>
      <ValueSlider
        label={`Strength, ${text}`}
        value={value}
        range={including(RANGE, value)}
        disabled={why !== ""}
        onMove={move}
        onEnd={end}
        onNudge={nudge}
      />
      {why !== "" && <span className="dim">{why}</span>}
    </>
  );
}
