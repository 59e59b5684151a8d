// Keys of a list of options: arrow keys lead from one to the next, and the Tab key reaches one of them.

import { type KeyboardEvent, useState } from "react";

const STEPS: Partial<Record<string, number>> = {
  ArrowDown: 1,
  ArrowUp: -1,
  PageDown: 10,
  PageUp: -10,
  Home: -Infinity,
  End: Infinity,
};

// `keys` are those of the options in their order; `active` is the one that the Tab key reaches.
export function useOptions(keys: readonly string[]) {
  const [last, setLast] = useState<string | null>(null);
  const active = last !== null && keys.includes(last) ? last : keys[0];
  return { active, setLast, onKeyDown: step };
}

// On the list: the focus moves.
function step(event: KeyboardEvent): void {
  const by = STEPS[event.key];
  const options = [...event.currentTarget.querySelectorAll<HTMLElement>("[role=option]")];
  const at = options.indexOf(document.activeElement as HTMLElement);
  if (by === undefined || at < 0 || event.ctrlKey || event.metaKey || event.altKey) {
    return;
  }
  event.preventDefault();
  event.stopPropagation();
  options[Math.min(options.length - 1, Math.max(0, at + by))]?.focus();
}

// On an option: a click, Enter and Space choose it.
export const choosing = (choose: () => void) => ({
  onClick: choose,
  onKeyDown: (event: KeyboardEvent) => {
    if (event.key === "Enter" || event.key === " ") {
      event.preventDefault();
      event.stopPropagation();
      choose();
    }
  },
});
