// The moment after some wall time of playing, forward or backward at a speed.

import type { TimelineView } from "../protocol";

// A page that was hidden does not jump when it is visible again.
const LONGEST_MS = 100;

export type Playing = { direction: 1 | -1; speed: number };

// The next moment, and whether it is the end in that direction.
export function played(
  at: number,
  elapsedMs: number,
  { direction, speed }: Playing,
  { first, last, second }: Pick<TimelineView, "first" | "last" | "second">,
): { time: number; ended: boolean } {
  const passed = (Math.min(elapsedMs, LONGEST_MS) / 1000) * second * speed;
  const time = Math.min(last, Math.max(first, at + direction * passed));
  return { time, ended: direction === 1 ? time >= last : time <= first };
}

export const REPLAY_SPEEDS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100] as const;

// The share of the slider, from its left end on, where moments were removed to save memory.
export function thinnedShare({ first, last, full_from }: TimelineView): number {
  return last > first ? (full_from - first) / (last - first) : 0;
}
