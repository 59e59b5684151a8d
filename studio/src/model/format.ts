// How times and speeds are written. All of one length as far as possible, so that read-outs keep still while
// they count.

import { decimals, grouped, SECONDS } from "../draw/text";
import type { CompilingView } from "../protocol";

const SYMBOLS: Record<string, string> = { us: "µs" };

// A simulated time: below a second in its own unit, above it in seconds.
export function timeText(time: number, unit: string, dt: number): string {
  const seconds = SECONDS[unit];
  if (seconds === undefined) {
    return grouped(time, Math.min(3, decimals(dt)));
  }
  if (unit === "s" || (seconds < 1 && Math.abs(time) * seconds >= 1)) {
    return `${grouped(time * seconds, 3)} s`;
  }
  return `${grouped(time, Math.min(3, decimals(dt)))} ${unitText(unit)}`;
}

// A unit of time beside a number; empty for custom units.
export function unitText(unit: string): string {
  return unit in SECONDS ? (SYMBOLS[unit] ?? unit) : "";
}

// The measured ratio to real time, three digits that matter: ×0.02, ×1.00, ×12.5, ×340.
export function factorText(factor: number): string {
  if (!Number.isFinite(factor)) {
    return "×–";
  }
  return factor < 10_000
    ? `×${grouped(factor, factor < 9.995 ? 2 : factor < 99.95 ? 1 : 0)}`
    : `×${Math.round(factor / 1000)}k`;
}

export function speedText(speed: number | null): string {
  return speed === null ? "max" : `${Number(speed.toPrecision(3))}×`;
}

// How long a compilation lasts already, and will in all: "2 s of about 5 s".
export function compilingText({ elapsed, expected }: CompilingView): string {
  const seconds = `${Math.floor(elapsed)} s`;
  const known = expected !== null && expected >= 1 && elapsed < 2 * expected;
  return known ? `${seconds} of about ${Math.round(expected)} s` : seconds;
}

export function countText(count: number): string {
  return grouped(count, 0);
}
