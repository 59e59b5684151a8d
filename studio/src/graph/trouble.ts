// What is wrong with an element, in words; empty where nothing is. Warnings do not count: the element runs.

import { useStudio, type Studio } from "../store";

export function useTrouble(element: string): string {
  return useStudio((state) => troubleOf(element, state));
}

export function troubleOf(element: string, { document, clock }: Pick<Studio, "document" | "clock">): string {
  const problem = clock?.failure.find((p) => p.element === element) ?? document?.problems.find((p) => p.element === element && p.severity !== "warning");
  return problem === undefined ? "" : [problem.what, problem.fix].filter((line) => line !== undefined && line !== "").join("\n");
}
