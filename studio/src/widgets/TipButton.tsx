// A button that is an icon. Its tooltip is its name, but for a key in brackets.

import { ActionIcon, type ActionIconProps, Tooltip } from "@mantine/core";
import type { ComponentPropsWithRef } from "react";

type TipButtonProps = ActionIconProps &
  Omit<ComponentPropsWithRef<"button">, keyof ActionIconProps> & { tip: string };

export function TipButton({ tip, ...button }: TipButtonProps) {
  return (
    <Tooltip label={tip}>
      <ActionIcon size={24} aria-label={tip.replace(/ \(.*/, "")} {...button} />
    </Tooltip>
  );
}
