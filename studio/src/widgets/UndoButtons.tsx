// Take changes back, and make them again.

import { IconArrowBackUp, IconArrowForwardUp } from "@tabler/icons-react";

import { keysText } from "../model/keys";
import { request } from "../server/socket";
import { undo as takeBack } from "../state/undo";
import { useStudio } from "../server/store";
import { IconButton } from "./Buttons";

export function UndoButtons() {
  const undo = useStudio((state) => state.document?.undo ?? 0);
  const redo = useStudio((state) => state.document?.redo ?? 0);
  const again = () => void request({ type: "redo" });
  return <HistoryButtons undo={undo} redo={redo} onUndo={() => void takeBack()} onRedo={again} />;
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
      <IconButton
        icon={IconArrowBackUp}
        label={`Undo${of}`}
        tip={`Undo (${keysText("Ctrl+Z")})`}
        disabled={undo === 0}
        onClick={onUndo}
      />
      <IconButton
        icon={IconArrowForwardUp}
        label={`Redo${of}`}
        tip={`Redo (${keysText("Ctrl+Shift+Z")})`}
        disabled={redo === 0}
        onClick={onRedo}
      />
    </>
  );
}
