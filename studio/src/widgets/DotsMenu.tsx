// The menu behind three dots at the end of a row.

import { ActionIcon, Menu } from "@mantine/core";
import { IconDots } from "@tabler/icons-react";
import type { ReactNode } from "react";
import { MenuList } from "./MenuList";

type DotsMenuProps = {
  label: string;
  children: ReactNode;
  // Where something else opens it too.
  opened?: boolean;
  onOpened?: (opened: boolean) => void;
};

export function DotsMenu({ label, children, opened, onOpened }: DotsMenuProps) {
  return (
    <Menu
      opened={opened}
      onChange={onOpened}
      position="bottom-end"

      classNames={{ dropdown: "compact-menu" }}
    >
      <Menu.Target>
        <ActionIcon className="row-menu" size={24} aria-label={label}>
          <IconDots size={14} />
        </ActionIcon>
      </Menu.Target>
      <MenuList>{children}</MenuList>
    </Menu>
  );
}
