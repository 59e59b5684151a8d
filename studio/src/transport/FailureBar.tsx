// The reason why the run stopped, below the header, until a reset or until the cause is removed.

import { Button, Code, Popover } from "@mantine/core";
import { IconAlertTriangle } from "@tabler/icons-react";

import { lastPart } from "../model/paths";
import { ProblemText } from "../widgets/ProblemText";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { reset } from "../actions/run";
import classes from "./FailureBar.module.css";

const NONE: [] = [];

export function FailureBar() {
  const failure = useStudio((state) => state.clock?.failure ?? NONE);
  if (failure.length === 0) {
    return null;
  }
  const untrusted = failure.some(({ trust }) => trust === true);
  return (
    <div className={classes.bar} role="alert">
      <IconAlertTriangle size={18} className={classes.icon} aria-hidden="true" />
      <div className={classes.problems}>
        <div className={classes.title}>
          {untrusted ? "The file names functions of its own, which can run any code." : "The run stopped"}
        </div>
        {failure.map((problem, i) => (
          <ProblemText key={i} problem={problem} />
        ))}
      </div>
      {untrusted ? (
        <TrustButtons />
      ) : (
        <Button size="compact-sm" color="red" variant="light" onClick={() => void reset()}>
          Reset
        </Button>
      )}
    </div>
  );
}

function TrustButtons() {
  const file = useStudio((state) => lastPart(state.document?.file ?? ""));
  return (
    <>
      <Button
        size="compact-sm"
        variant="default"
        onClick={() => void request({ type: "open_without_functions" })}
      >
        Open without them
      </Button>
      <Popover position="bottom-end" width={360} withArrow shadow="md" trapFocus returnFocus>
        <Popover.Target>
          <Button size="compact-sm" variant="default">
            How to trust it
          </Button>
        </Popover.Target>
        <Popover.Dropdown aria-label="How to trust it">
          Read the functions first: they can read, change and send all that you can. Then end the studio, and
          start it with your trust:
          <Code block mt={6} tabIndex={0}>
            deodar studio {file === "" ? "FILE" : file} --trust
          </Code>
        </Popover.Dropdown>
      </Popover>
    </>
  );
}
