// A folded group: one box with its name and how much is in it.

import { ActionIcon } from "@mantine/core";
import { IconChevronRight } from "@tabler/icons-react";
import { Handle, Position, type NodeProps } from "@xyflow/react";
import { memo } from "react";
import { useStudio } from "../store";
import { fold } from "./arrange";
import { MarkIcon } from "./Mark";
import type { FoldedNode } from "./scene";
import { problemOf, warningOf } from "./problem";
import { keyOf } from "./tree";

export const Folded = memo(function Folded({ data: { key, name, count } }: NodeProps<FoldedNode>) {
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
  return (
    <div
      className="graph-folded"
      data-problem={inside || undefined}
      data-selected={selected || undefined}
      onDoubleClick={(event) => {
        event.stopPropagation();
        fold(key, false);
      }}
    >
      <Handle type="target" position={Position.Left} isConnectable={false} />
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
      <Handle type="source" position={Position.Right} isConnectable={false} />
    </div>
  );
});

function within(group: string[], key: string): boolean {
  const own = keyOf(group);
  return own === key || own.startsWith(`${key}/`);
}
