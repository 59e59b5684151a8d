// What is wrong with an element: in the document, and in the run.

import { IconAlertOctagon, IconAlertTriangle } from "@tabler/icons-react";

import { RepairButtons } from "./RepairButtons";
import { isWarning } from "../model/severity";
import { useSame } from "../state/useSame";

export function ProblemBanner({ element }: { element: string }) {
  const problems = useSame(({ clock, document }) =>
    [...(clock?.failure ?? []), ...(document?.problems ?? [])].filter((p) => (p.element ?? "") === element),
  );
  if (problems.length === 0) {
    return null;
  }
  const warning = problems.every(isWarning);
  const Icon = warning ? IconAlertTriangle : IconAlertOctagon; // the same shapes as on the boxes
  return (
    <div className="problem-banner" role="alert" data-warning={warning || undefined}>
      <Icon size={16} />
      <ul>
        {problems.map((problem, i) => (
          <li key={i}>
            {isWarning(problem) && "Warning: "}
            {problem.what}
            {problem.fix !== undefined && problem.fix !== "" && (
              <div className="problem-fix">{problem.fix}</div>
            )}
            <RepairButtons problem={problem} />
          </li>
        ))}
      </ul>
    </div>
  );
}
