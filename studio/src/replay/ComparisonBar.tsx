// The first differences of two records, below the slider; a click shows the moment.

import { Button, CloseButton, Progress } from "@mantine/core";
import { IconArrowsDiff } from "@tabler/icons-react";

import { lastPart } from "../model/paths";
import { ProblemText } from "../widgets/ProblemText";
import type { Comparison, DifferenceView } from "../protocol";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { timeText } from "../model/format";
import { chooseCopy, seek, stop } from "../actions/replay";
import classes from "./Comparison.module.css";

export function ComparisonBar() {
  const comparison = useStudio((state) => state.comparison);
  if (comparison === null) {
    return null;
  }
  return (
    <section className={classes.bar} aria-label="Comparison of records">
      <IconArrowsDiff size={16} aria-hidden="true" />
      <span className={`${classes.against} one-line`} title={comparison.path}>
        Compared with {lastPart(comparison.path)}
      </span>
      <Found comparison={comparison} />
      <CloseButton
        size="sm"
        aria-label="End the comparison"
        onClick={() => void request({ type: "end_comparison" })}
      />
    </section>
  );
}

function Found({ comparison }: { comparison: Comparison }) {
  const { progress, compared, differences, notes, problems } = comparison;
  return (
    <div className={`flow ${classes.found}`} role="status" aria-label="Differences">
      {progress < 1 && (
        <div className={`flow ${classes.progress}`}>
          <Progress value={100 * progress} w={120} aria-label="Share that was compared" />
          <span className="numbers">{Math.floor(100 * progress)} %</span>
        </div>
      )}
      {problems.map((problem, i) => (
        <ProblemText key={i} problem={problem} />
      ))}
      {progress === 1 && problems.length === 0 && differences.length === 0 && (
        <span>No difference in {compared === 1 ? "1 port" : `${compared} ports`}.</span>
      )}
      {differences.length > 0 && (
        <div className={classes.list}>
          {differences.map((difference) => (
            <Jump key={difference.path} difference={difference} />
          ))}
        </div>
      )}
      {notes.map((note) => (
        <span key={note} className="dim">
          {note}
        </span>
      ))}
    </div>
  );
}

function Jump({ difference }: { difference: DifferenceView }) {
  const unit = useStudio((state) => state.document?.time_unit ?? "");
  const step = useStudio((state) => state.clock?.timeline?.step ?? 1);
  const copies = useStudio((state) => state.document?.record?.copies);
  const { path, time, copy, at, value, other } = difference;
  const which = Object.entries(copy).map(
    ([name, index]) => `${name} ${copies?.find((one) => one.name === name)?.values[index] ?? index}`,
  );
  const where = [...which, ...(at === "" ? [] : [at])].join(", ");
  const jump = () => {
    stop();
    Object.entries(copy).forEach(([name, index]) => chooseCopy(name, index));
    seek(time);
  };
  return (
    <Button
      size="compact-xs"
      variant="default"
      fw={400}
      onClick={jump}
      title={`Show the first difference of ${path}`}
    >
      <span className="numbers">
        <b>{path}</b> first differs at {timeText(time, unit, step)}: {number(value)} and {number(other)}
        {where === "" ? "" : ` (${where})`}
      </span>
    </Button>
  );
}

// With more digits than elsewhere: values that differ should look different.
function number(value: number | null): string {
  return value === null ? "not finite" : String(Number(value.toPrecision(8)));
}
