// Warnings of a missing connection wait until nothing was edited for a while: a box that was just made is not
// finished.

import type { Checked, ListedProblem } from "../protocol";
import { useStudio } from "./store";

const WAIT_MS = 4000;

let timer: ReturnType<typeof setTimeout> | undefined;

const isMissing = ({ severity, wire }: ListedProblem): boolean =>
  severity === "warning" && wire != null && (wire.source === "" || wire.target === "");

// By identifiers, which a new name leaves as they are.
const keysOf = (problems: readonly ListedProblem[]): string[] =>
  problems.filter(isMissing).map(({ wire }) => JSON.stringify(wire));

// What was shown last. Where an edit has an error, the page shows the error alone until all is checked.
let last: { session: number; keys: readonly string[] } = { session: -1, keys: [] };

function remember(problems: readonly ListedProblem[]): void {
  if (problems.length === 0 || problems.some(({ severity }) => severity === "warning")) {
    last = { session: useStudio.getState().session, keys: keysOf(problems) };
  }
}

// The message without new warnings of this sort; `show` gets all of it, unless another one comes before.
export function withoutNew(
  message: Checked,
  shown: readonly ListedProblem[],
  show: (message: Checked) => void,
): Checked {
  clearTimeout(timer);
  const before = last.session === useStudio.getState().session ? last.keys : [];
  const known = new Set([...before, ...keysOf(shown)]);
  const problems = message.problems.filter((problem) => keysOf([problem]).every((key) => known.has(key)));
  remember(problems);
  if (problems.length < message.problems.length) {
    timer = setTimeout(() => {
      remember(message.problems);
      show(message);
    }, WAIT_MS);
  }
  return { ...message, problems };
}
