// A trajectory in a plane: two time courses against each other, or one with its rate of change.

import type { History } from "../../server/history";
import { sideBySide } from "../../draw/series";

export type Trajectory = { times: number[]; across: number[]; up: number[] };

// The samples within a range of time. Without a second time course the rate of change of the first: the
// difference of two samples over that of their times, at the middle between them.
export function trajectory(
  across: History,
  up: History | null,
  [first, last]: readonly [number, number],
): Trajectory {
  const [times, one = [], other = []] = sideBySide(up === null ? [across] : [across, up], first);
  const found: Trajectory = { times: [], across: [], up: [] };
  const add = (time: number, x: number, y: number) => {
    if (time >= first && time <= last && Number.isFinite(x) && Number.isFinite(y)) {
      found.times.push(time);
      found.across.push(x);
      found.up.push(y);
    }
  };
  for (let i = 0; i < times.length; i++) {
    const [time, x] = [times[i] as number, one[i] ?? NaN];
    if (up !== null) {
      add(time, x, other[i] ?? NaN);
    } else if (i > 0) {
      const [before, from] = [times[i - 1] as number, one[i - 1] ?? NaN];
      add((before + time) / 2, (from + x) / 2, (x - from) / (time - before));
    }
  }
  return found;
}
