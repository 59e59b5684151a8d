// The buttons of the canvas.

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
import { openSearch } from "../commands/commands";
import { openPalette } from "../actions/palette";
import { useOffline } from "../widgets/NeedsServer";
import { IconButton, type IconButtonProps } from "../widgets/Buttons";

type Props = {
  onShow: () => void;
  onTidy: () => void;
  // Whether a large architecture shows every element; null where it always does.
  every: boolean | null;
  onEvery: (shown: boolean) => void;
};

export function Controls({ onShow, onTidy, every, onEvery }: Props) {
  const { zoomIn, zoomOut } = useReactFlow();
  const offline = useOffline();
  return (
    <div className="graph-controls" role="toolbar" aria-label="Canvas">
      <Control
        icon={IconSquarePlus}
        label="Add an element ( / )"
        disabled={offline}
        onClick={() => openPalette(null)}
      />
      <Control icon={IconSearch} label="Search (Ctrl+F)" onClick={openSearch} />
      <Control icon={IconPlus} label="Zoom in" onClick={() => void zoomIn()} />
      <Control icon={IconMinus} label="Zoom out" onClick={() => void zoomOut()} />
      <Control icon={IconMaximize} label="Show everything" onClick={onShow} />
      <Control
        icon={IconSitemap}
        className="graph-tidy"
        label={every === false ? "Tidy to grid" : "Tidy: compute a new layout"}
        disabled={offline}
        onClick={onTidy}
      />
      {every !== null && (
        <Control
          icon={every ? IconArrowsMinimize : IconArrowsDiagonal}
          label={every ? "Couplings on wires, stimuli in boxes" : "Show every element"}
          disabled={offline}
          onClick={() => onEvery(!every)}
        />
      )}
    </div>
  );
}

const Control = (props: IconButtonProps) => <IconButton position="right" {...props} />;

export const GLIDE_MS = 200;
