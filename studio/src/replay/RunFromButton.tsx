// Lets the run continue from the moment shown, with the noise and the parameters of that moment.

import { Button, Tooltip } from "@mantine/core";
import { IconArrowFork } from "@tabler/icons-react";
import { useState } from "react";

import { useStudio } from "../store";
import { runFrom } from "./replay";
import classes from "./Timeline.module.css";

const LABEL =
  "Run from here: the run continues from this moment, with its noise and its parameters. What came after it" +
  " is forgotten; Ctrl+Z brings the later parameters back.";

export function RunFromButton() {
  const past = useStudio((state) => state.clock?.timeline?.time != null);
  const [asked, setAsked] = useState(false);
  const press = async () => {
    setAsked(true);
    await runFrom();
    setAsked(false);
  };
  return (
    <Tooltip label={LABEL} multiline w={300}>
      <Button
        size="compact-xs"
        variant="default"
        className={classes.from}
        leftSection={<IconArrowFork size={14} />}
        disabled={!past || asked}
        aria-label="Run from here"
        onClick={() => void press()}
      >
        <span className={classes.word}>Run from here</span>
      </Button>
    </Tooltip>
  );
}
