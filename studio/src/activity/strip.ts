// The strip of an element: its greatest activation over the newest times.

import type { Range } from "../draw/scale";
import type { History } from "../server/history";
import { activationScale } from "../model/colors";
import { type Level, thresholdOf } from "../model/levels";
import { timeRange } from "../model/traces";

// In units of time of the document, as plots over time show it at first.
export const STRIP_TIME = 2000;
export const COLUMNS = 120;
// Of colours, in distances from the threshold to the resting level, so that all strips have one scale.
export const STRIP_RANGE: Range = [-2, 2.5];
export const STRIP_COLORS = activationScale(STRIP_RANGE[0], STRIP_RANGE[1], 0);

// `columns` as `STRIP_RANGE` has them, NaN where there is no sample; `newest` in units of the activation.
export type ActivityStrip = Readonly<{ columns: Float32Array; newest: number; above: boolean }>;

// From the samples until a time; null where there are none, and without a threshold.
export function stripOf(
  { times, values }: Readonly<Pick<History, "times" | "values">>,
  end: number,
  levels: readonly Level[],
): ActivityStrip | null {
  const threshold = thresholdOf(levels);
  const count = times.findLastIndex((time) => time <= end) + 1;
  const [first, last, newest] = [times[0], times[count - 1], values[count - 1]];
  if (threshold === null || first === undefined || last === undefined || newest === undefined) {
    return null;
  }
  const rest = levels.find(({ label }) => label === "resting level")?.value ?? threshold;
  const unit = Math.abs(threshold - rest) || 1;
  const [from, to] = timeRange(first, last, STRIP_TIME);
  const columnOf = (time: number) => Math.floor((COLUMNS * (time - from)) / (to - from));
  const columns = new Float32Array(COLUMNS).fill(NaN);
  // A sample holds until the next one.
  let until = Math.min(COLUMNS, columnOf(last) + 1);
  for (let i = count - 1; i >= 0 && until > 0; i--) {
    const column = Math.min(COLUMNS - 1, columnOf(times[i] as number));
    const level = ((values[i] as number) - threshold) / unit;
    for (let c = Math.max(0, column); c < Math.max(until, column + 1); c++) {
      columns[c] = Number.isNaN(columns[c]) ? level : Math.max(columns[c] as number, level);
    }
    until = column;
  }
  return { columns, newest, above: newest > threshold };
}
