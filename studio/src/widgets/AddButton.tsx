// The quiet button that adds something to a list.

import { Button, type ButtonProps } from "@mantine/core";
import { IconPlus } from "@tabler/icons-react";
import type { ComponentPropsWithRef } from "react";

type AddButtonProps = ButtonProps & Omit<ComponentPropsWithRef<"button">, keyof ButtonProps>;

export function AddButton({ children = "Add", className = "", ...rest }: AddButtonProps) {
  return (
    <Button
      size="compact-xs"
      variant="subtle"
      className={`add-button ${className}`}
      leftSection={<IconPlus size={12} />}
      {...rest}
    >
      {children}
    </Button>
  );
}
