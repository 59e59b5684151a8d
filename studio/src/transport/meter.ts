// How well the run keeps to real time, in words.

import type { RunClock } from "../protocol";
import { countText, unitText } from "../model/format";

export type Kept = Pick<
  RunClock,
  "running" | "speed" | "dt" | "steps" | "lag" | "worst" | "lost" | "overruns" | "longest" | "lengthened"
>;

// Below this a lag is no more than the time between two exchanges with the page, in milliseconds.
const EXCHANGE_MS = 10;

// The lag beside the factor; empty where the run keeps up.
export function lateText(clock: Kept): string {
  return clock.running && clock.speed !== null && clock.lag > EXCHANGE_MS
    ? `${millisecondsText(clock.lag)} late`
    : "";
}

// The lines of the tooltip; `pace` describes the factor.
export function meterLines(pace: string, clock: Kept, unit: string): string[] {
  if (!clock.running) {
    return [pace];
  }
  const lines = [pace, `${countText(clock.steps)} steps in a second`];
  if (clock.speed !== null) {
    lines.push(
      `Behind by ${millisecondsText(clock.lag)},` +
        ` at most ${millisecondsText(clock.worst)} since it was played`,
    );
    lines.push(
      clock.overruns === 0
        ? "Never fell behind"
        : `Fell behind ${clock.overruns === 1 ? "once" : `${countText(clock.overruns)} times`}`,
    );
  }
  if (clock.lost > 0) {
    lines.push(`${millisecondsText(clock.lost)} were skipped and will not be caught up`);
  }
  if (clock.lengthened > 0) {
    const length = `${Number(clock.dt.toPrecision(6))} ${unitText(unit)}`.trimEnd();
    lines.push(`${countText(clock.lengthened)} steps were lengthened; now they are ${length}`);
  }
  return lines;
}

// A wall time: milliseconds below ten seconds, seconds above.
export function millisecondsText(milliseconds: number): string {
  return milliseconds < 9999.5
    ? `${milliseconds < 9.95 ? milliseconds.toFixed(1) : Math.round(milliseconds)} ms`
    : `${countText(milliseconds / 1000)} s`;
}
