// The reason why the run stopped, below the header, until a reset or until the cause is removed.

import { Button } from "@mantine/core";
import { IconAlertTriangle } from "@tabler/icons-react";

import { ProblemText } from "../problems/ProblemText";
import { useStudio } from "../store";
import { reset } from "./run";
import classes from "./FailureBar.module.css";

const NONE: [] = [];

export function FailureBar() {
  const failure = useStudio((state) => state.clock?.failure ?? NONE);
  if (failure.length === 0) {
    return null;
  }
  return (
    <div className={classes.bar} role="alert">
      <IconAlertTriangle size={18} className={classes.icon} aria-hidden="true" />
      <div className={classes.problems}>
        <div className={classes.title}>The run stopped</div>
        {failure.map((problem, i) => (
          <ProblemText key={i} problem={problem} />
        ))}
      </div>
      <Button size="compact-sm" color="red" variant="light" onClick={() => void reset()}>
        Reset
      </Button>
    </div>
  );
}
