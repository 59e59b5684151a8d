// The problems of an element as text; empty without one. A warning marks an element too: it runs, but
// probably not as intended.

import { isWarning } from "../problems/severity";
import type { ListedProblem } from "../protocol";
import { useStudio, type Studio } from "../store";

type Said = Pick<Studio, "document" | "clock">;

export function useProblem(element: string): string {
  return useStudio((state) => problemOf(element, state));
}

export function useWarning(element: string): string {
  return useStudio((state) => warningOf(element, state));
}

// The failure of the run first, then the first problem of the document.
export function problemOf(element: string, { document, clock }: Said): string {
  const own = (problem: ListedProblem) => problem.element === element && !isWarning(problem);
  const problem = clock?.failure.find(own) ?? document?.problems.find(own);
  return problem === undefined ? "" : text(problem);
}

// All warnings: each of them is a mistake of its own.
export function warningOf(element: string, { document }: Said): string {
  const found =
    document?.problems.filter((problem) => problem.element === element && isWarning(problem)) ?? [];
  return found.map(text).join("\n\n");
}

function text({ what, fix }: ListedProblem): string {
  return [what, fix].filter((line) => line !== undefined && line !== "").join("\n");
}
