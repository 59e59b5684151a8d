// Problems and warnings of the open document, in a list; a click selects the element. Absent without either.

import { Button, Popover } from "@mantine/core";
import { IconAlertTriangle } from "@tabler/icons-react";

import { RepairButtons } from "../problems/RepairButtons";
import type { ListedProblem } from "../protocol";
import { useStudio } from "../server/store";
import { countText, isWarning } from "../model/severity";
import { ProblemText } from "../widgets/ProblemText";
import classes from "./header.module.css";

const NONE: ListedProblem[] = [];

export function ProblemsMenu() {
  const problems = useStudio((state) => state.document?.problems ?? NONE);
  if (problems.length === 0) {
    return null;
  }
  const label = countText(problems);
  return (
    <Popover position="bottom-end" withArrow shadow="md" trapFocus returnFocus>
      <Popover.Target>
        <Button
          size="compact-sm"
          color={problems.every(isWarning) ? "yellow" : "red"}
          variant="light"
          px={7}
          styles={{ label: { color: "var(--text)" } }}
          leftSection={<IconAlertTriangle size={15} />}
          aria-label={label}
          title={label}
        >
          {problems.length}
        </Button>
      </Popover.Target>
      <Popover.Dropdown p={6} w={400}>
        <ul className={classes.problems} aria-label={label}>
          {problems.map((problem, i) => (
            <li key={i}>
              <Entry problem={problem} />
              <div className={classes.repair}>
                <RepairButtons problem={problem} />
              </div>
            </li>
          ))}
        </ul>
      </Popover.Dropdown>
    </Popover>
  );
}

function Entry({ problem }: { problem: ListedProblem }) {
  const { element = "" } = problem;
  const text = <ProblemText problem={problem} />;
  return element === "" ? (
    <div className="list-entry">{text}</div>
  ) : (
    <button type="button" className="list-entry" onClick={() => useStudio.getState().select([element])}>
      {text}
    </button>
  );
}
