// Warnings of a missing connection wait until nothing was edited for a while: a box that was just made is not
// finished.

import type { Checked, ListedProblem } from "../protocol";

const WAIT_MS = 4000;

let timer: ReturnType<typeof setTimeout> | undefined;

const isMissing = ({ severity, wire }: ListedProblem): boolean =>
  severity === "warning" && wire != null && (wire.source === "" || wire.target === "");

const keyOf = ({ where = "", what }: ListedProblem): string => `${where}\n${what}`;

// The message without new warnings of this sort; `show` gets all of it, unless another one comes before.
export function withoutNew(
  message: Checked,
  shown: readonly ListedProblem[],
  show: (message: Checked) => void,
): Checked {
  clearTimeout(timer);
  const known = new Set(shown.map(keyOf));
  const problems = message.problems.filter((problem) => !isMissing(problem) || known.has(keyOf(problem)));
  if (problems.length < message.problems.length) {
    timer = setTimeout(() => show(message), WAIT_MS);
  }
  return { ...message, problems };
}
