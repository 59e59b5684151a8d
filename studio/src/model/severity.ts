// Numbers of problems and of warnings in words.

import type { ListedProblem } from "../protocol";

export function isWarning(problem: ListedProblem): boolean {
  return problem.severity === "warning";
}

// "1 problem, 2 warnings"; empty without either.
export function countText(found: readonly ListedProblem[]): string {
  const warnings = found.filter(isWarning).length;
  return [counted(found.length - warnings, "problem"), counted(warnings, "warning")]
    .filter((text) => text !== "")
    .join(", ");
}

function counted(n: number, noun: string): string {
  return n === 0 ? "" : n === 1 ? `1 ${noun}` : `${n} ${noun}s`;
}
