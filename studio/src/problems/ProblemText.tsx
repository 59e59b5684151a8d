// One thing that is wrong: where, what, what to do about it.

import type { ListedProblem } from "../protocol";
import { isWarning } from "./severity";
import classes from "./ProblemText.module.css";

export function ProblemText({ problem }: { problem: ListedProblem }) {
  return (
    <div className={classes.problem}>
      {problem.where !== undefined && problem.where !== "" && (
        <div className={classes.where}>{problem.where}</div>
      )}
      <div className={classes.what}>
        {isWarning(problem) && "Warning: "}
        {problem.what}
      </div>
      {problem.fix !== undefined && problem.fix !== "" && <div className={classes.fix}>{problem.fix}</div>}
    </div>
  );
}
