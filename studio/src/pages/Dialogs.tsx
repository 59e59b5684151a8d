// The question that stands before the page, as a window of its own.

import { Modal } from "@mantine/core";

import { ChooseDialog } from "./ChooseDialog";
import { ReplaceDialog } from "./ReplaceDialog";
import { SaveAsDialog } from "./SaveAsDialog";
import { ShortcutsDialog } from "./ShortcutsDialog";
import { UnsavedDialog } from "./UnsavedDialog";
import { type Asked, useDialogs } from "./dialogs";

export function Dialogs() {
  const { asked, cancel } = useDialogs();
  return (
    <Modal opened={asked !== null} onClose={cancel} title={asked === null ? "" : titleOf(asked)} size={sizeOf(asked)} centered
      zIndex={350} transitionProps={{ duration: 0 }} overlayProps={{ backgroundOpacity: 0.4 }} closeButtonProps={{ "aria-label": "Close" }}
      styles={{ title: { fontSize: 16, fontWeight: 600 } }}>
      {asked !== null && contentOf(asked)}
    </Modal>
  );
}

function contentOf(asked: Asked) {
  switch (asked.name) {
    case "unsaved":
      return <UnsavedDialog {...asked} />;
    case "replace":
      return <ReplaceDialog {...asked} />;
    case "choose":
      return <ChooseDialog {...asked} />;
    case "save_as":
      return <SaveAsDialog {...asked} />;
    case "shortcuts":
      return <ShortcutsDialog />;
  }
}

function titleOf(asked: Asked): string {
  switch (asked.name) {
    case "unsaved":
      return "Keep the unsaved edits?";
    case "replace":
      return "Write over the file?";
    case "choose":
      return asked.question.wants === "files" ? "Open a file" : "Choose a picture";
    case "save_as":
      return "Save as";
    case "shortcuts":
      return "Keys and mouse";
  }
}

function sizeOf(asked: Asked | null): number {
  switch (asked?.name) {
    case "unsaved":
    case "replace":
      return 440;
    case "shortcuts":
      return 660;
    default:
      return 560;
  }
}
