// The question in a modal window.

import { Modal } from "@mantine/core";
import { type ComponentType, useEffect } from "react";

import { useOffline } from "../widgets/NeedsServer";
import { WorldDialog } from "./WorldDialog";
import { ChooseDialog } from "./ChooseDialog";
import { ReplaceDialog, TakenDialog, UnsavedDialog } from "./MessageDialogs";
import { type Asked, type Asking, useDialogs } from "../state/questions";
import { SaveAsDialog } from "./SaveAsDialog";
import { ShortcutsDialog } from "./ShortcutsDialog";

type DialogKind<P> = { title: string; size: number; Content: ComponentType<P> };

const DIALOGS: { [K in Asked["name"]]: DialogKind<Asking<K>> } = {
  unsaved: { title: "Keep the unsaved edits?", size: 440, Content: UnsavedDialog },
  replace: { title: "Overwrite the file?", size: 440, Content: ReplaceDialog },
  choose: { title: "Open a file", size: 560, Content: ChooseDialog },
  save_as: { title: "Save as", size: 560, Content: SaveAsDialog },
  taken: { title: "What did not match", size: 560, Content: TakenDialog },
  shortcuts: { title: "Keys and mouse", size: 660, Content: ShortcutsDialog },
  world: { title: "World of the sensors and motors", size: 560, Content: WorldDialog },
};

const WANTED = {
  files: "Open a file",
  pictures: "Choose a picture",
  values: "Apply the values of a file",
  records: "Compare with another record",
  experiments: "Open an experiment",
};

export function Dialogs() {
  const { asked, cancel } = useDialogs();
  const offline = useOffline();
  useEffect(() => {
    if (offline && asked !== null && asked.name !== "shortcuts") {
      cancel();
    }
  }, [offline, asked, cancel]);
  const { title = "", size, Content } = asked === null ? {} : (DIALOGS[asked.name] as DialogKind<Asked>);
  return (
    <Modal
      opened={asked !== null}
      onClose={cancel}
      title={asked?.name === "choose" ? WANTED[asked.question.wants] : title}
      size={size}
      centered
      zIndex={350}
      transitionProps={{ duration: 0 }}
      overlayProps={{ backgroundOpacity: 0.4 }}
      closeButtonProps={{ "aria-label": "Close" }}
      styles={{ title: { fontSize: 16, fontWeight: 600 } }}
    >
      {asked !== null && Content !== undefined && <Content {...asked} />}
    </Modal>
  );
}
