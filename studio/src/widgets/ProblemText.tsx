// What is wrong: where, what, what to do about it.

import type { ListedProblem } from "../protocol";
import classes from "./problems.module.css";
import { isWarning } from "../model/severity";

export function ProblemText({ problem }: { problem: ListedProblem }) {
  const { where = "", what, fix = "" } = problem;
  return (
    <div className={`wrapped ${classes.text}`}>
      {where !== "" && <div className={`dim small ${classes.where}`}>{where}</div>}
      <div className={classes.what}>
        {isWarning(problem) && "Warning: "}
        {what}
      </div>
      {fix !== "" && <div className="dim">{fix}</div>}
    </div>
  );
}

export function ProblemTexts({ problems = [] }: { problems: readonly ListedProblem[] | undefined }) {
  return problems.map((problem, i) => <ProblemText key={i} problem={problem} />);
}
