// A folded group: one box with its name, how much is in it, and the ports that are connected with the
// outside.

import { ActionIcon } from "@mantine/core";
import { IconChevronRight } from "@tabler/icons-react";
import { Handle, Position, type NodeProps } from "@xyflow/react";
import { memo, useMemo, useRef } from "react";
import type { Side } from "../../model/ends";
import { usePicked } from "../../actions/picked";
import { useFitMarks } from "../../actions/useFitMarks";
import { askFits, useWiring } from "../../actions/wiring";
import { useStudio } from "../../server/store";
import { fold } from "../../actions/arrange";
import { portHeight } from "../../architecture/boxes";
import { FOLDED } from "../../architecture/layout";
import { MarkIcon } from "../../problems/Mark";
import type { FoldedNode, FoldedPort } from "../../architecture/nodes";
import { portHandle } from "../../architecture/scene";
import { problemOf, warningOf } from "../../state/problem";
import { keyOf } from "../../architecture/tree";

export const Folded = memo(function Folded({ data }: NodeProps<FoldedNode>) {
  const { key, name, count, inputs, outputs } = data;
  const inside = useStudio(
    (state) =>
      state.document?.elements.some((e) => within(e.group, key) && problemOf(e.id, state) !== "") ?? false,
  );
  const warned = useStudio(
    (state) =>
      state.document?.elements.some((e) => within(e.group, key) && warningOf(e.id, state) !== "") ?? false,
  );
  const mark = inside ? "A problem is in this group" : warned ? "A warning is in this group" : "";
  const selected = useStudio((state) =>
    state.selected.some((id) => within(state.elements.get(id)?.group ?? [], key)),
  );
  const holder = useRef<HTMLDivElement>(null);
  const marked = useMemo(
    () => [...inputs, ...outputs].map((port) => ({ ...port, handle: portHandle(port) })),
    [inputs, outputs],
  );
  useFitMarks(holder, marked);
  const into = usePicked((state) => state.into === key);
  return (
    <div
      ref={holder}
      className="graph-folded"
      data-problem={inside || undefined}
      data-selected={selected || undefined}
      data-into={into || undefined}
      onDoubleClick={(event) => {
        event.stopPropagation();
        fold(key, false);
      }}
    >
      <Ports side="target" shown={inputs} />
      <ActionIcon
        className="nodrag"
        size="sm"
        aria-label={`Unfold ${key}`}
        title="Unfold this group"
        onClick={(event) => {
          event.stopPropagation();
          fold(key, false);
        }}
      >
        <IconChevronRight size={15} />
      </ActionIcon>
      <div className="graph-folded-words">
        <div className="graph-box-name one-line" title={key}>
          {name}
        </div>
        <div className="graph-box-kind">{count === 1 ? "1 element" : `${count} elements`}</div>
      </div>
      {mark !== "" && (
        <span className="graph-mark" role="img" aria-label={mark} title={mark}>
          <MarkIcon problem={inside} size={16} />
        </span>
      )}
      <Ports side="source" shown={outputs} />
    </div>
  );
});

type BorderPortsProps = { side: Side; shown: FoldedPort[] };

// The wires of the group end at one handle in the middle.
function Ports({ side, shown }: BorderPortsProps) {
  const position = side === "target" ? Position.Left : Position.Right;
  return (
    <>
      <Handle type={side} position={position} isConnectable={false} />
      {shown.map((port, n) => (
        <BorderPort
          key={portHandle(port)}
          side={side}
          position={position}
          top={portHeight(FOLDED.height, n, shown.length)}
          port={port}
        />
      ))}
    </>
  );
}

type BorderPortProps = { side: Side; position: Position; top: number; port: FoldedPort };

// A port of an element inside.
function BorderPort({ side, position, top, port: { element, port, path } }: BorderPortProps) {
  return (
    <Handle
      id={portHandle({ element, port })}
      type={side}
      position={position}
      style={{ top }}
      title={path}
      onPointerEnter={() => {
        if (useWiring.getState().wiring === null) {
          void askFits({ element, port });
        }
      }}
    />
  );
}

function within(group: string[], key: string): boolean {
  const own = keyOf(group);
  return own === key || own.startsWith(`${key}/`);
}
