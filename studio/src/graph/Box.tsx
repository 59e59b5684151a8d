// An element on the canvas: its name, its kind, its live values, its ports.

import { Handle, Position, type NodeProps } from "@xyflow/react";
import { memo } from "react";
import { useStudio } from "../store";
import { BOX, LIVE, liveHeight, portHeight, shownPort } from "./boxes";
import { useHover } from "./hover";
import { LiveBox } from "./LiveBox";
import { Mark } from "./Mark";
import type { BoxNode } from "./scene";
import { useProblem, useWarning } from "./problem";

export const Box = memo(function Box({ data, height = BOX.title }: NodeProps<BoxNode>) {
  const { element: id, path, name, title, inputs, outputs } = data;
  const selected = useStudio((state) => state.selected.includes(id));
  const port = useStudio((state) => shownPort(state.elements.get(id), state.document?.record?.ports[id]));
  const live = useStudio((state) => known(state.elements.get(id), liveHeight) ?? 0);
  const problem = useProblem(id);
  const warning = useWarning(id);
  const { enter, leave } = useHover.getState();
  return (
    <div
      className="graph-box"
      data-selected={selected || undefined}
      data-problem={problem !== "" || undefined}
      data-marked={problem !== "" || warning !== "" || undefined}
      onPointerEnter={(event) => enter(id, event.currentTarget)}
      onPointerLeave={leave}
    >
      <Ports names={inputs} side="target" height={height} />
      <div className="graph-box-head">
        <div className="graph-box-name one-line" title={path}>
          {name}
        </div>
        <div className="graph-box-kind one-line">{title}</div>
        <Mark element={id} />
      </div>
      {port !== null && (
        <LiveBox
          element={id}
          port={port}
          label={`${port} of ${path}, live`}
          width={LIVE.width}
          height={live}
        />
      )}
      <Ports names={outputs} side="source" height={height} />
    </div>
  );
});

// The name of a port is worth its place only where there are several.
function Ports({ names, side, height }: { names: string[]; side: "source" | "target"; height: number }) {
  return names.map((name, n) => {
    const top = portHeight(height, n, names.length);
    return (
      <Handle
        key={name}
        id={name}
        type={side}
        position={side === "target" ? Position.Left : Position.Right}
        style={{ top }}
        title={name}
      >
        {names.length > 1 && <span className={`graph-port graph-port-${side}`}>{name}</span>}
      </Handle>
    );
  });
}

function known<T, R>(value: T | undefined, of: (value: T) => R): R | null {
  return value === undefined ? null : of(value);
}
