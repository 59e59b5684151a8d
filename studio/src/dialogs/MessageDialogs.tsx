// Questions that a press of one of a few buttons answers.

import { Button, Group, Text } from "@mantine/core";
import type { ReactNode } from "react";

import { takenText } from "../files/presets";
import classes from "./dialogs.module.css";
import type { Asking } from "../state/questions";

type MessageButton = { children: string; onClick: () => void; color?: string };
type Props = {
  children: ReactNode;
  cancel?: () => void;
  other?: MessageButton | false;
  first: MessageButton;
};

// `first` has the focus.
function Message({ children, cancel, other, first }: Props) {
  return (
    <>
      <Text size="sm" component="div" className="wrapped">
        {children}
      </Text>
      <Group gap="xs" mt="lg" justify="flex-end">
        {cancel !== undefined && <CancelButton cancel={cancel} />}
        {other && <Button variant="default" {...other} />}
        <Button {...first} data-autofocus autoFocus />
      </Group>
    </>
  );
}

export function CancelButton({ cancel }: { cancel: () => void }) {
  return (
    <Button variant="subtle" color="gray" onClick={cancel}>
      Cancel
    </Button>
  );
}

// Asks about unsaved edits before another document is opened.
export function UnsavedDialog({ question: { title }, answer }: Asking<"unsaved">) {
  return (
    <Message
      cancel={() => answer("cancel")}
      other={{ children: "Discard edits", onClick: () => answer("discard") }}
      first={{ children: "Save", onClick: () => answer("save") }}
    >
      <b>{title || "The document"}</b> was edited since it was saved.
    </Message>
  );
}

// A file is in the way, or it was changed by something else since it was read.
export function ReplaceDialog({ question: { path, own }, answer }: Asking<"replace">) {
  return (
    <Message
      cancel={() => answer("cancel")}
      other={{ children: "Write over it", color: "red", onClick: () => answer("replace") }}
      first={{ children: "Save as…", onClick: () => answer("elsewhere") }}
    >
      <b>{path}</b> {own ? "was changed on disk since it was opened or saved here." : "is there already."}
    </Message>
  );
}

// The values of a file that did not match when they were applied.
export function TakenDialog({ question: { file, carried, unmatched }, answer }: Asking<"taken">) {
  const label = `${unmatched.length === 1 ? "1 entry" : `${unmatched.length} entries`} did not match`;
  return (
    <Message
      other={carried > 0 && { children: "Undo", onClick: () => answer("undo") }}
      first={{ children: carried > 0 ? "Keep" : "Close", onClick: () => answer("keep") }}
    >
      {takenText(carried, file)} {label} and left the values here unchanged:
      <ul className={classes.unmatched} aria-label={label} tabIndex={0}>
        {unmatched.map((line, i) => (
          <li key={i}>{line}</li>
        ))}
      </ul>
    </Message>
  );
}
