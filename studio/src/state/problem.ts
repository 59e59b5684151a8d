// The problems of an element as text; empty without one. A warning marks an element too: it runs, but
// probably not as intended.

import { isWarning } from "../model/severity";
import type { ListedProblem } from "../protocol";
import { useStudio, type Studio } from "../server/store";

type Said = Pick<Studio, "document" | "clock">;

export function useProblem(element: string): string {
  return useStudio((state) => problemOf(element, state));
}

export function useWarning(element: string): string {
  return useStudio((state) => warningOf(element, state));
}

// The failure of the run first, then the first problem of the document.
export function problemOf(element: string, { document, clock }: Said): string {
  const [problem] = [clock?.failure, document?.problems].flatMap((problems) =>
    saidOf(element, problems).filter((one) => !isWarning(one)),
  );
  return problem === undefined ? "" : text(problem);
}

// All warnings: each of them is a mistake of its own.
export function warningOf(element: string, { document }: Said): string {
  return saidOf(element, document?.problems).filter(isWarning).map(text).join("\n\n");
}

type Problems = readonly ListedProblem[];

// Every box asks with every clock: a list is sorted by elements once.
const sorted = new WeakMap<Problems, Map<string | undefined, ListedProblem[]>>();

function saidOf(element: string, problems: Problems = []): Problems {
  if (problems.length > 0 && !sorted.has(problems)) {
    const all = new Map<string | undefined, ListedProblem[]>();
    for (const problem of problems) {
      all.set(problem.element, [...(all.get(problem.element) ?? []), problem]);
    }
    sorted.set(problems, all);
  }
  return sorted.get(problems)?.get(element) ?? [];
}

function text({ what, fix }: ListedProblem): string {
  return [what, fix].filter((line) => line !== undefined && line !== "").join("\n");
}
