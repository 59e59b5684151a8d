// The small buttons of panels, bars and menus.

import { ActionIcon, type ActionIconProps, Button, type ButtonProps, Menu, Tooltip } from "@mantine/core";
import type { MenuItemProps } from "@mantine/core";
import type { IconPlus } from "@tabler/icons-react";
import type { ComponentPropsWithRef, ReactNode } from "react";

import { keysText } from "../model/keys";

type Icon = typeof IconPlus;
type Of<P> = P & Omit<ComponentPropsWithRef<"button">, keyof P>;

type PanelButtonProps = Of<ButtonProps> & { icon?: Icon; label: ReactNode };

export function PanelButton({ icon: Icon, label, ...rest }: PanelButtonProps) {
  return (
    <Button
      flex="none"
      size="compact-sm"
      variant="default"
      leftSection={Icon && <Icon size={15} />}
      {...rest}
    >
      {label}
    </Button>
  );
}

// An icon with its name below the pointer; `tip` says more.
export type IconButtonProps = Of<ActionIconProps> & {
  icon: Icon;
  label: string;
  tip?: string;
  position?: "right";
};

export function IconButton(props: IconButtonProps) {
  const { icon: Icon, label, tip = label, position, size = 28, ...rest } = props;
  return (
    <Tooltip label={tip} position={position}>
      <ActionIcon aria-label={label} size={size} {...rest}>
        <Icon size={Math.round(0.6 * Number(size))} />
      </ActionIcon>
    </Tooltip>
  );
}

type MenuEntryProps = Of<MenuItemProps> & { icon: Icon; label: string; keys?: string };

export function MenuEntry({ icon: Icon, label, keys, ...rest }: MenuEntryProps) {
  const right = keys !== undefined && <span className="dim small">{keysText(keys)}</span>;
  return (
    <Menu.Item leftSection={<Icon size={16} stroke={1.6} />} rightSection={right} {...rest}>
      {label}
    </Menu.Item>
  );
}
