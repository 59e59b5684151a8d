// Take changes back, and make them again.

import { ActionIcon, Tooltip } from "@mantine/core";
import { IconArrowBackUp, IconArrowForwardUp } from "@tabler/icons-react";

import { keysText } from "../shortcuts";
import { request } from "../socket";
import { useStudio } from "../store";

export function UndoButtons() {
  const undo = useStudio((state) => state.document?.undo ?? 0);
  const redo = useStudio((state) => state.document?.redo ?? 0);
  return (
    <>
      <Tooltip label={`Undo (${keysText("Ctrl+Z")})`}>
        <ActionIcon
          aria-label="Undo"
          size={28}
          disabled={undo === 0}
          onClick={() => void request({ type: "undo" })}
        >
          <IconArrowBackUp size={18} />
        </ActionIcon>
      </Tooltip>
      <Tooltip label={`Redo (${keysText("Ctrl+Shift+Z")})`}>
        <ActionIcon
          aria-label="Redo"
          size={28}
          disabled={redo === 0}
          onClick={() => void request({ type: "redo" })}
        >
          <IconArrowForwardUp size={18} />
        </ActionIcon>
      </Tooltip>
    </>
  );
}
