// The small cross that removes an entry of a list.

import { ActionIcon } from "@mantine/core";
import { IconX } from "@tabler/icons-react";

export function RemoveButton({ label, onClick }: { label: string; onClick: () => unknown }) {
  return (
    <ActionIcon size={20} aria-label={label} onClick={() => void onClick()}>
      <IconX size={13} />
    </ActionIcon>
  );
}
