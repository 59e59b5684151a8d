// An element on the canvas: its name, its kind, its live values, its ports.

import { Handle, Position, type NodeProps } from "@xyflow/react";
import { memo, useEffect, useMemo, useRef } from "react";
import { Sketch } from "../../widgets/Sketch";
import { useFitMarks } from "../../actions/useFitMarks";
import { askFits, useWiring } from "../../actions/wiring";
import { useStudio } from "../../server/store";
import { BOX, dimensionsText, LIVE, liveHeight, portHeight, shownPort } from "../../architecture/boxes";
import { BoxPins } from "./BoxPins";
import { useHover } from "../../state/hover";
import { LiveBox } from "./LiveBox";
import { unhover, useFocus } from "../../actions/focus";
import { Mark } from "../../problems/Mark";
import { nameParts } from "./nameParts";
import { Parts } from "./ContractedParts";
import type { BoxNode } from "../../architecture/nodes";
import { useProblem, useWarning } from "../../state/problem";
import { useDetail } from "./useDetail";

export const Box = memo(function Box({ data, height = BOX.title, isConnectable }: NodeProps<BoxNode>) {
  const { element: id, path, name, title, inputs, outputs } = data;
  const level = useDetail(id);
  const selected = useStudio((state) => state.selected.includes(id));
  const port = useStudio((state) => shownPort(state.elements.get(id), state.document?.record?.ports[id]));
  const live = useStudio((state) => known(state.elements.get(id), liveHeight) ?? 0);
  const problem = useProblem(id);
  const warning = useWarning(id);
  const holder = useRef<HTMLDivElement>(null);
  const marked = useMemo(
    () => [...inputs, ...outputs].map((name) => ({ element: id, port: name, handle: name })),
    [id, inputs, outputs],
  );
  useFitMarks(holder, marked);
  const reached = useWiring((state) => state.target === id);
  const far = useFocus(({ near }) => near !== null && !near.has(id));
  const { enter, leave } = useHover.getState();
  // a box that disappears below the pointer is not left by it
  useEffect(() => () => unhover(id), [id]);
  const ports = (side: PortsProps["side"], names: string[]) =>
    level === "dot" ? (
      <Anchors names={names} side={side} height={height} />
    ) : (
      <Ports element={id} names={names} side={side} height={height} connectable={isConnectable} />
    );
  return (
    <div
      ref={holder}
      className="graph-box"
      data-source={inputs.length === 0 || undefined}
      data-reached={reached || undefined}
      data-selected={selected || undefined}
      data-tall={live > LIVE.number || undefined}
      data-far={far || undefined}
      data-problem={problem !== "" || undefined}
      data-marked={problem !== "" || warning !== "" || undefined}
      onPointerEnter={({ currentTarget }) => {
        useFocus.setState({ hovered: id });
        if (useWiring.getState().wiring === null) {
          enter(id, currentTarget);
        }
      }}
      onPointerLeave={() => {
        unhover(id);
        leave();
      }}
    >
      {ports("target", inputs)}
      <div className="graph-box-head">
        <div className="graph-box-name" title={path}>
          {nameParts(name).map(({ text, hyphen }, i) => (
            <span key={i}>
              {text}
              {hyphen ? <span className="graph-hyphen" /> : <wbr />}
            </span>
          ))}
        </div>
        <Signs title={title} kind={data.kind} dimensions={data.dimensions} />
        <Mark element={id} />
      </div>
      {port !== null && level !== "dot" && (
        <LiveBox
          element={id}
          port={port}
          label={`${port} of ${path}, live`}
          width={level === "full" ? LIVE.width : LIVE.small}
          height={level === "full" ? live : LIVE.number}
        />
      )}
      {level === "full" && <BoxPins pins={data.pins} />}
      {level !== "dot" && <Parts dots={data.dots} badges={data.badges} />}
      {ports("source", outputs)}
    </div>
  );
});

// The kind in words and as the palette draws it, and the number of dimensions.
function Signs({ title, kind, dimensions }: Pick<BoxNode["data"], "title" | "kind" | "dimensions">) {
  const known = useStudio((state) => state.kinds.get(kind));
  return (
    <div className="graph-box-kind">
      <span className="one-line">{title}</span>
      {known !== undefined && <Sketch kind={known} />}
      {dimensions !== null && (
        <span className="graph-dimensions" title={dimensionsText(dimensions)}>
          {dimensions}-D
        </span>
      )}
    </div>
  );
}

// The name of a port is worth its place only where there are several.
type PortsProps = {
  element: string;
  names: string[];
  side: "source" | "target";
  height: number;
  connectable: boolean;
};

function Ports({ element, names, side, height, connectable }: PortsProps) {
  return names.map((name, n) => {
    const top = portHeight(height, n, names.length);
    return (
      <Handle
        key={name}
        id={name}
        type={side}
        isConnectable={connectable}
        position={side === "target" ? Position.Left : Position.Right}
        style={{ top }}
        onPointerEnter={() => {
          useHover.getState().close();
          if (useWiring.getState().wiring === null) {
            void askFits({ element, port: name });
          }
        }}
        title={name}
      >
        {names.length > 1 && <span className={`graph-port graph-port-${side}`}>{name}</span>}
      </Handle>
    );
  });
}

// The places of ports that are not shown: xyflow measures them and draws the wires to them.
function Anchors({ names, side, height }: Pick<PortsProps, "names" | "side" | "height">) {
  return names.map((name, n) => (
    <div
      key={name}
      className={`graph-anchor ${side}`}
      data-handleid={name === "" ? undefined : name}
      data-handlepos={side === "target" ? Position.Left : Position.Right}
      style={{ top: portHeight(height, n, names.length) }}
    />
  ));
}

function known<T, R>(value: T | undefined, of: (value: T) => R): R | null {
  return value === undefined ? null : of(value);
}
