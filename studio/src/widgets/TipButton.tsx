// A button that is an icon. Its tooltip is its name, but for a key in brackets.

import { ActionIcon, type ActionIconProps, Tooltip } from "@mantine/core";
import type { ComponentPropsWithRef } from "react";

type TipButtonProps = ActionIconProps &
  Omit<ComponentPropsWithRef<"button">, keyof ActionIconProps> & { tip: string; tipless?: boolean };

export function TipButton({ tip, tipless = false, ...button }: TipButtonProps) {
  return (
    <Tooltip label={tip} disabled={tipless}>
      <ActionIcon size={24} aria-label={tip.replace(/ \(.*/, "")} {...button} />
    </Tooltip>
  );
}
