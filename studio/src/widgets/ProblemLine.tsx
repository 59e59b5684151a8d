// What is wrong with the last try, beside the field.

import "./fields.css";

import type { ListedProblem } from "../protocol";

export function ProblemLine({ problem }: { problem: ListedProblem | null }) {
  return (
    <div className="problem-line" role="alert" hidden={problem === null}>
      {problem !== null &&
        [problem.what, problem.fix].filter((text) => text !== undefined && text !== "").join(". ")}
    </div>
  );
}
