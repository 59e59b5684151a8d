// The range that a small picture is drawn in: it grows at once and shrinks slowly, so that the eye can
// compare.

export type Span = { lower: number; upper: number };

const SHRINK = 0.04;
const LEAST = 1e-9;

// The span for the next picture; it always holds 0.
export function follow(last: Span | null, values: ArrayLike<number>): Span {
  let lower = 0;
  let upper = 0;
  for (let i = 0; i < values.length; i++) {
    const value = values[i] ?? 0;
    if (value < lower && value > -Infinity) {
      lower = value;
    } else if (value > upper && value < Infinity) {
      upper = value;
    }
  }
  if (last === null) {
    return { lower, upper };
  }
  return {
    lower: lower <= last.lower ? lower : last.lower + SHRINK * (lower - last.lower),
    upper: upper >= last.upper ? upper : last.upper + SHRINK * (upper - last.upper),
  };
}

// As it is drawn: never empty.
export function open({ lower, upper }: Span): Span {
  return upper - lower < LEAST ? { lower: -1, upper: 1 } : { lower, upper };
}
