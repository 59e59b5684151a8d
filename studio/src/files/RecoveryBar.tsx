// Unsaved edits of the open file that were stored when the studio ended.

import { Button } from "@mantine/core";
import { IconRestore } from "@tabler/icons-react";

import { request } from "../socket";
import { useStudio } from "../store";
import { leave } from "./flows";
import { belowRoot } from "./paths";
import { whenText } from "./when";
import classes from "./RecoveryBar.module.css";

export function RecoveryBar() {
  const file = useStudio((state) => state.document?.file ?? "");
  const root = useStudio((state) => state.welcome?.root ?? "");
  const gallery = useStudio((state) => state.gallery);
  const found = gallery?.recoveries.find((recovery) => belowRoot(root, recovery.file) === file);
  if (file === "" || found === undefined) {
    return null;
  }
  const { name, title, when, experiment } = found;
  const what = experiment === "" ? title : `the experiment ${experiment}`;
  return (
    <section className={classes.bar} aria-label="Unsaved edits">
      <IconRestore size={16} aria-hidden="true" />
      <span className={classes.text}>
        Unsaved edits of <b>{what}</b>, stored {whenText(when, new Date())}, were found.
      </span>
      <Button size="compact-sm" onClick={() => void leave({ type: "recover", name })}>
        Open them
      </Button>
      <Button size="compact-sm" variant="default" onClick={() => void request({ type: "forget", name })}>
        Discard
      </Button>
    </section>
  );
}
