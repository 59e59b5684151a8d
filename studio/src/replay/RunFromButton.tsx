// Lets the run continue from the moment shown; that of a record in a copy of its document.

import { Button, Tooltip } from "@mantine/core";
import { IconArrowFork } from "@tabler/icons-react";
import { useState } from "react";

import type { RecordView } from "../protocol";
import { useStudio } from "../server/store";
import { runFrom } from "../actions/replay";
import classes from "./Timeline.module.css";

const LABEL =
  "Run from here: the run continues from this moment, with its noise and its parameters. What came after it" +
  " is forgotten; Ctrl+Z brings the later parameters back.";

const OF_RECORD =
  "Run from here: a copy of the document runs on from this moment, as the recorded run did. For this the" +
  " run is repeated from its start.";

const OF_SEVERAL =
  "A run continues from a record of a single run; this one has several trials or points of a sweep.";

function label(record: RecordView | null): string {
  return record === null ? LABEL : record.copies.length > 0 ? OF_SEVERAL : OF_RECORD;
}

export function RunFromButton() {
  const past = useStudio((state) => state.clock?.timeline?.time != null);
  const record = useStudio((state) => state.document?.record ?? null);
  const [asked, setAsked] = useState(false);
  const press = async () => {
    setAsked(true);
    await runFrom();
    setAsked(false);
  };
  return (
    <Tooltip label={label(record)} multiline w={300}>
      <Button
        size="compact-xs"
        variant="default"
        className={classes.from}
        leftSection={<IconArrowFork size={14} />}
        disabled={!past || asked || (record !== null && record.copies.length > 0)}
        aria-label="Run from here"
        onClick={() => void press()}
      >
        <span className={classes.word}>Run from here</span>
      </Button>
    </Tooltip>
  );
}
