// What can be done with a pinned row.

import { Menu } from "@mantine/core";
import {
  IconArrowsHorizontal,
  IconPencil,
  IconPinnedOff,
  IconToggleLeft,
  IconWand,
} from "@tabler/icons-react";

import { DotsMenu } from "../widgets/DotsMenu";
import { MoveItems } from "../widgets/MoveItems";

type PinMenuProps = {
  path: string;
  place: { index: number; count: number };
  // Whether the range was chosen.
  ranged: boolean;
  onEdit: (what: "range" | "label") => void;
  onAutomatic: () => void;
  // Whether it is a switch.
  switched: boolean;
  onSwitch: (switched: boolean) => void;
  onMove: (to: number) => void;
  onUnpin: () => void;
};

export function PinMenu({
  path,
  place,
  ranged,
  onEdit,
  onAutomatic,
  switched,
  onSwitch,
  onMove,
  onUnpin,
}: PinMenuProps) {
  return (
    <DotsMenu label={`More for ${path}`}>
      <Menu.Item leftSection={<IconArrowsHorizontal size={14} />} onClick={() => onEdit("range")}>
        Change range…
      </Menu.Item>
      <Menu.Item leftSection={<IconWand size={14} />} disabled={!ranged} onClick={onAutomatic}>
        Automatic range
      </Menu.Item>
      <Menu.Item leftSection={<IconToggleLeft size={14} />} onClick={() => onSwitch(!switched)}>
        {switched ? "Show as slider" : "Show as switch"}
      </Menu.Item>
      <Menu.Item leftSection={<IconPencil size={14} />} onClick={() => onEdit("label")}>
        Rename…
      </Menu.Item>
      <MoveItems place={place} onMove={onMove} />
      <Menu.Item leftSection={<IconPinnedOff size={14} />} onClick={onUnpin}>
        Unpin
      </Menu.Item>
    </DotsMenu>
  );
}
