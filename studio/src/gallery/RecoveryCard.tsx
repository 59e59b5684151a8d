// Unsaved edits that were kept when the studio ended.

import { Button } from "@mantine/core";
import { IconRestore } from "@tabler/icons-react";

import type { Recovery } from "../protocol";
import { request } from "../socket";
import { leave } from "../files/flows";
import { whenText } from "../files/when";
import classes from "./RecoveryCard.module.css";

export function RecoveryCard({ recovery: { name, title, file, when, experiment } }: { recovery: Recovery }) {
  const what = experiment === "" ? title : `the experiment ${experiment}`;
  return (
    <section className={classes.card} aria-label={`Unsaved edits of ${what}`}>
      <IconRestore size={20} stroke={1.6} className={classes.icon} aria-hidden="true" />
      <div className={classes.text}>
        <div>
          Unsaved edits of <b>{what}</b>, kept {whenText(when, new Date())}
        </div>
        {file !== "" && <div className={classes.file}>{file}</div>}
      </div>
      <Button size="xs" onClick={() => void leave({ type: "recover", name })}>
        Open
      </Button>
      <Button size="xs" variant="default" onClick={() => void request({ type: "forget", name })}>
        Discard
      </Button>
    </section>
  );
}
