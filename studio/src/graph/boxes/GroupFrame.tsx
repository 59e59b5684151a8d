// An open group: a frame around its elements, moved by its title.

import { ActionIcon } from "@mantine/core";
import { IconChevronDown } from "@tabler/icons-react";
import type { NodeProps } from "@xyflow/react";
import { memo } from "react";
import { usePicked } from "../../actions/picked";
import { fold } from "../../actions/arrange";
import type { FrameNode } from "../../architecture/nodes";

export const GroupFrame = memo(function GroupFrame({ data: { key, name } }: NodeProps<FrameNode>) {
  const picked = usePicked((state) => state.groups.includes(key));
  const into = usePicked((state) => state.into === key);
  return (
    <div className="graph-frame" data-selected={picked || undefined} data-into={into || undefined}>
      <div className="graph-frame-title">
        <ActionIcon
          className="nodrag"
          size="sm"
          aria-label={`Fold ${key}`}
          title="Fold this group"
          onClick={(event) => {
            event.stopPropagation();
            fold(key, true);
          }}
        >
          <IconChevronDown size={15} />
        </ActionIcon>
        <span className="one-line" title={key}>
          {name}
        </span>
      </div>
    </div>
  );
});
