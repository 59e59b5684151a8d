// The question in a modal window.

import { Modal } from "@mantine/core";

import { useEffect } from "react";

import { ChooseDialog } from "./ChooseDialog";
import { useOffline } from "../connection/NeedsServer";
import { ReplaceDialog } from "./ReplaceDialog";
import { SaveAsDialog } from "./SaveAsDialog";
import { ShortcutsDialog } from "./ShortcutsDialog";
import { TakenDialog } from "./TakenDialog";
import { WorldDialog } from "../world/WorldDialog";
import { UnsavedDialog } from "./UnsavedDialog";
import { type Asked, useDialogs } from "./questions";

export function Dialogs() {
  const { asked, cancel } = useDialogs();
  const offline = useOffline();
  useEffect(() => {
    if (offline && asked !== null && asked.name !== "shortcuts") {
      cancel();
    }
  }, [offline, asked, cancel]);
  return (
    <Modal
      opened={asked !== null}
      onClose={cancel}
      title={asked === null ? "" : titleOf(asked)}
      size={sizeOf(asked)}
      centered
      zIndex={350}
      transitionProps={{ duration: 0 }}
      overlayProps={{ backgroundOpacity: 0.4 }}
      closeButtonProps={{ "aria-label": "Close" }}
      styles={{ title: { fontSize: 16, fontWeight: 600 } }}
    >
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
    case "taken":
      return <TakenDialog {...asked} />;
    case "shortcuts":
      return <ShortcutsDialog />;
    case "world":
      return <WorldDialog {...asked} />;
  }
}

const WANTED = {
  files: "Open a file",
  pictures: "Choose a picture",
  values: "Apply the values of a file",
  records: "Compare with another record",
  experiments: "Open an experiment",
};

function titleOf(asked: Asked): string {
  switch (asked.name) {
    case "unsaved":
      return "Keep the unsaved edits?";
    case "replace":
      return "Overwrite the file?";
    case "choose":
      return WANTED[asked.question.wants];
    case "save_as":
      return "Save as";
    case "taken":
      return "What did not match";
    case "shortcuts":
      return "Keys and mouse";
    case "world":
      return "World of the sensors and motors";
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
