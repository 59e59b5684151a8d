// What the buttons and the keys do with the run.

import type { Answer } from "../protocol";
import { isPast, isRecord, replay, seekFirst, seekFrames, stop } from "./replay";
import { request } from "../server/socket";
import { pageStore } from "../state/pageStore";
import { useStudio } from "../server/store";

// What the page keeps for the next press: how many steps, and a seed that waits for the next reset (null: the
// one in use stays).
type Next = { steps: number; seed: number | null };

export const useNext = pageStore<Next>(() => ({ steps: 1, seed: null }));

export const MOST_SEED = 2 ** 32 - 1;

export function play(): Promise<Answer> | void {
  if (isRecord()) {
    return replay(1);
  }
  stop();
  const running = useStudio.getState().clock?.running === true;
  return request({ type: running && !isPast() ? "pause" : "play" });
}

export function step(): Promise<Answer> | void {
  if (isRecord()) {
    return seekFrames(1);
  }
  stop();
  return request({ type: "step", n: useNext.getState().steps });
}

export async function reset(): Promise<void> {
  if (isRecord()) {
    return seekFirst();
  }
  stop();
  const { seed } = useNext.getState();
  const answer = await request({ type: "reset", seed });
  if ((answer.problems ?? []).length === 0) {
    useNext.setState({ seed: null });
  }
}

export function rollSeed(): void {
  useNext.setState({ seed: Math.floor(Math.random() * 10_000) });
}
