// The buttons of the canvas.

import { ActionIcon, Tooltip } from "@mantine/core";
import {
  IconArrowsDiagonal,
  IconArrowsMinimize,
  IconMaximize,
  IconMinus,
  IconPlus,
  IconSearch,
  IconSitemap,
  IconSquarePlus,
} from "@tabler/icons-react";
import { useReactFlow } from "@xyflow/react";
import type { ReactNode } from "react";
import { openPalette } from "../build/palette/palette";
import { useOffline } from "../connection/NeedsServer";

type Props = {
  onShow: () => void;
  onSearch: () => void;
  onTidy: () => void;
  // Whether a large architecture shows every element; null where it always does.
  every: boolean | null;
  onEvery: (shown: boolean) => void;
};

export function Controls({ onShow, onSearch, onTidy, every, onEvery }: Props) {
  const { zoomIn, zoomOut } = useReactFlow();
  const offline = useOffline();
  return (
    <div className="graph-controls" role="toolbar" aria-label="Canvas">
      <Control label="Add an element ( / )" disabled={offline} onClick={() => openPalette(null)}>
        <IconSquarePlus size={17} />
      </Control>
      <Control label="Search (Ctrl+F)" onClick={onSearch}>
        <IconSearch size={16} />
      </Control>
      <Control label="Zoom in" onClick={() => void zoomIn()}>
        <IconPlus size={16} />
      </Control>
      <Control label="Zoom out" onClick={() => void zoomOut()}>
        <IconMinus size={16} />
      </Control>
      <Control label="Show everything" onClick={onShow}>
        <IconMaximize size={16} />
      </Control>
      <Control
        label={every === false ? "Tidy to grid" : "Tidy: compute a new layout"}
        disabled={offline}
        onClick={onTidy}
      >
        <IconSitemap size={16} style={{ transform: "rotate(-90deg)" }} />
      </Control>
      {every !== null && (
        <Control
          label={every ? "Couplings on wires, stimuli in boxes" : "Show every element"}
          disabled={offline}
          onClick={() => onEvery(!every)}
        >
          {every ? <IconArrowsMinimize size={16} /> : <IconArrowsDiagonal size={16} />}
        </Control>
      )}
    </div>
  );
}

export const GLIDE_MS = 200;

type ControlProps = { label: string; disabled?: boolean; onClick: () => void; children: ReactNode };

function Control({ label, disabled, onClick, children }: ControlProps) {
  return (
    <Tooltip label={label} position="right">
      <ActionIcon size="md" aria-label={label} disabled={disabled} onClick={onClick}>
        {children}
      </ActionIcon>
    </Tooltip>
  );
}
