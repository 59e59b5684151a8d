// A popover of a button, with fields; a tooltip says what is in it.

import { type BoxProps, Popover, type PopoverProps, Tooltip } from "@mantine/core";
import { type ReactElement, type ReactNode, useState } from "react";

import { useAfterFields } from "./afterFields";

type ButtonPopoverProps = {
  tip: string;
  width: BoxProps["w"];
  position?: PopoverProps["position"];
  // The button, which opens and closes.
  button: (toggle: () => void) => ReactElement;
  onOpen?: () => void;
  children: ReactNode;
};

export function ButtonPopover(props: ButtonPopoverProps) {
  const { tip, width, position = "bottom", button, onOpen, children } = props;
  const [opened, setOpened] = useState(false);
  const afterFields = useAfterFields();
  const toggle = () => {
    setOpened(!opened);
    if (!opened) {
      onOpen?.();
    }
  };
  return (
    <Popover
      opened={opened}
      onChange={setOpened}
      {...afterFields}
      position={position}
      withArrow
      trapFocus
      returnFocus
    >
      <Popover.Target>
        <Tooltip label={tip} disabled={opened}>
          {button(toggle)}
        </Tooltip>
      </Popover.Target>
      <Popover.Dropdown p="md" w={width} maw="100vw">
        {children}
      </Popover.Dropdown>
    </Popover>
  );
}
