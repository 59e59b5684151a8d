// The frames around the cells of a grid, behind all boxes and wires.

import { ViewportPortal } from "@xyflow/react";
import type { CellFrame } from "../../architecture/contracted";

export function CellFrames({ frames }: { frames: CellFrame[] }) {
  return (
    <ViewportPortal>
      {frames.map(({ name, x, y, width, height }) => (
        <div
          key={`${name} ${x}`}
          className="graph-cells"
          style={{ transform: `translate(${x}px, ${y}px)`, width, height }}
        >
          {name}
        </div>
      ))}
    </ViewportPortal>
  );
}
