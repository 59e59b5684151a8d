// What is wrong with an element, as a mark on its box: an octagon for a problem, a triangle for a warning. It
// selects the element.

import { IconAlertOctagon, IconAlertTriangle } from "@tabler/icons-react";
import { useStudio } from "../server/store";
import { useProblem, useWarning } from "../state/problem";

export function Mark({ element }: { element: string }) {
  const problem = useProblem(element);
  const warning = useWarning(element);
  if (problem === "" && warning === "") {
    return null;
  }
  const text = problem !== "" ? `Problem: ${problem}` : `Warning: ${warning}`;
  return (
    <button
      type="button"
      className="graph-mark nodrag nopan"
      title={text}
      aria-label={text}
      onClick={(event) => {
        event.stopPropagation();
        useStudio.getState().select([element]);
      }}
    >
      <MarkIcon problem={problem !== ""} size={16} />
    </button>
  );
}

export function MarkIcon({ problem, size }: { problem: boolean; size: number }) {
  const Icon = problem ? IconAlertOctagon : IconAlertTriangle;
  return (
    <Icon
      className="graph-mark-icon"
      data-severity={problem ? "problem" : "warning"}
      size={size}
      aria-hidden
    />
  );
}
