// What to do with a document without elements.

import { Button, Kbd } from "@mantine/core";
import { IconPlus } from "@tabler/icons-react";

import { openPalette } from "../actions/palette";

export function EmptyHint() {
  return (
    <div className="graph-empty">
      <p>This document has no elements yet.</p>
      <Button size="compact-sm" leftSection={<IconPlus size={15} />} onClick={() => openPalette(null)}>
        Add an element
      </Button>
      <p>
        or double-click on the canvas, or press <Kbd size="xs">/</Kbd>
      </p>
    </div>
  );
}
