// What is wrong with an experiment, by the card that it concerns.

import type { ListedProblem } from "../protocol";

export function problemsAt(problems: ListedProblem[], place: string): ListedProblem[] {
  return problems.filter(
    ({ where = "" }) => where === place || where.startsWith(`${place}.`) || where.startsWith(`${place}:`),
  );
}

// Problems of no card.
export function otherProblems(problems: ListedProblem[], places: string[]): ListedProblem[] {
  const placed = new Set(places.flatMap((place) => problemsAt(problems, place)));
  return problems.filter((problem) => !placed.has(problem));
}
