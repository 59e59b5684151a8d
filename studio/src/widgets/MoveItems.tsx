// The menu items that move an item of a list by one place.

import { Menu } from "@mantine/core";
import { IconArrowDown, IconArrowUp } from "@tabler/icons-react";

type MoveItemsProps = {
  place: { index: number; count: number };
  onMove: (to: number) => void;
};

export function MoveItems({ place, onMove }: MoveItemsProps) {
  const { index, count } = place;
  return (
    <>
      <Menu.Item
        leftSection={<IconArrowUp size={14} />}
        disabled={index === 0}
        onClick={() => onMove(index - 1)}
      >
        Move up
      </Menu.Item>
      <Menu.Item
        leftSection={<IconArrowDown size={14} />}
        disabled={index === count - 1}
        onClick={() => onMove(index + 1)}
      >
        Move down
      </Menu.Item>
    </>
  );
}
