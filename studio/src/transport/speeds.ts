// The stops of the speed slider: slow motion, real time, fast, and as fast as possible.

export const SPEEDS: readonly (number | null)[] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, null];

// The stop nearest to a speed, on a scale of ratios.
export function stopOf(speed: number | null): number {
  if (speed === null) {
    return SPEEDS.length - 1;
  }
  const distance = (stop: number | null) => (stop === null ? Infinity : Math.abs(Math.log(stop / speed)));
  return SPEEDS.reduce<number>(
    (best, stop, i) => (distance(stop) < distance(SPEEDS[best] ?? null) ? i : best),
    0,
  );
}
