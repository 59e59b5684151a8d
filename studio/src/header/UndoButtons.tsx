// Take changes back, and make them again.

import { ActionIcon, Tooltip } from "@mantine/core";
import { IconArrowBackUp, IconArrowForwardUp } from "@tabler/icons-react";

import { keysText } from "../keys";
import { request } from "../socket";
import { undo as takeBack } from "../state/undo";
import { useStudio } from "../store";

export function UndoButtons() {
  const undo = useStudio((state) => state.document?.undo ?? 0);
  const redo = useStudio((state) => state.document?.redo ?? 0);
  return (
    <HistoryButtons
      undo={undo}
      redo={redo}
      onUndo={() => void takeBack()}
      onRedo={() => void request({ type: "redo" })}
    />
  );
}

type HistoryButtonsProps = {
  // The numbers of changes.
  undo: number;
  redo: number;
  // What changes belong to, if not the document.
  of?: string;
  onUndo: () => void;
  onRedo: () => void;
};

export function HistoryButtons({ undo, redo, of = "", onUndo, onRedo }: HistoryButtonsProps) {
  return (
    <>
      <Tooltip label={`Undo (${keysText("Ctrl+Z")})`}>
        <ActionIcon aria-label={`Undo${of}`} size={28} disabled={undo === 0} onClick={onUndo}>
          <IconArrowBackUp size={18} />
        </ActionIcon>
      </Tooltip>
      <Tooltip label={`Redo (${keysText("Ctrl+Shift+Z")})`}>
        <ActionIcon aria-label={`Redo${of}`} size={28} disabled={redo === 0} onClick={onRedo}>
          <IconArrowForwardUp size={18} />
        </ActionIcon>
      </Tooltip>
    </>
  );
}
