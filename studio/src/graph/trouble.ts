// What is wrong with an element, in words; empty where nothing is.

import { useStudio, type Studio } from "../store";

export function useTrouble(element: string): string {
  return useStudio((state) => troubleOf(element, state));
}

export function troubleOf(element: string, { document, clock }: Pick<Studio, "document" | "clock">): string {
  const problem = clock?.failure.find((p) => p.element === element) ?? document?.problems.find((p) => p.element === element);
  return problem === undefined ? "" : [problem.what, problem.fix].filter((line) => line !== undefined && line !== "").join("\n");
}
