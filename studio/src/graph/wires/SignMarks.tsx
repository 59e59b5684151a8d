// The marks at the ends of edges, as in `draw`: an arrow for excitation, a dot for inhibition, both for both.
// They differ in shape, so that a print without colours shows them. At a port that an arrow reaches too, the
// dot lies behind it.

import type { ReactNode } from "react";
import type { Sign } from "../../architecture/sign";

const IDS: Record<Sign, string> = {
  "+": "graph-excitation",
  "-": "graph-inhibition",
  "±": "graph-mixed",
};
const BEHIND = "graph-inhibition-behind";

// The mark of an edge; `shared`: whether an arrow ends there too.
export const markOf = (sign: Sign, shared: boolean): string => (sign === "-" && shared ? BEHIND : IDS[sign]);

const ARROW = "M-11,-5 L0,0 L-11,5 Z";
const DOT = 4.5;
const [NEAR, FAR] = [5, 15.5];

export function SignMarks() {
  return (
    <svg className="graph-marks" aria-hidden="true">
      <defs>
        <SignMark id={IDS["+"]} sign="+">
          <path d={ARROW} />
        </SignMark>
        <SignMark id={IDS["-"]} sign="-">
          <circle cx={-NEAR} r={DOT} />
        </SignMark>
        <SignMark id={BEHIND} sign="-">
          <circle cx={-FAR} r={DOT} />
        </SignMark>
        <SignMark id={IDS["±"]} sign="±">
          <path d={ARROW} />
          <circle cx={-FAR} r={DOT} />
        </SignMark>
      </defs>
    </svg>
  );
}

function SignMark({ id, sign, children }: { id: string; sign: Sign; children: ReactNode }) {
  return (
    <marker
      id={id}
      className="graph-sign"
      data-sign={sign}
      viewBox="-24 -8 26 16"
      markerWidth={26}
      markerHeight={16}
      markerUnits="userSpaceOnUse"
      orient="auto"
    >
      {children}
    </marker>
  );
}
