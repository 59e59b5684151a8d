// Several time courses: samples of different times on one axis.

type Samples = Readonly<{ times: readonly number[]; values: readonly number[] }>;

export type Traces = [times: readonly number[], ...values: (readonly (number | null)[])[]];

// The samples from `from` on of several histories; where one of them has no sample at a time, null.
export function sideBySide(histories: readonly Samples[], from: number): Traces {
  const parts = histories.map(({ times, values }) => {
    const start = firstAt(times, from);
    return { times: times.slice(start), values: values.slice(start) };
  });
  const first = parts[0];
  if (first === undefined) {
    return [[]];
  }
  if (parts.every((part) => sameTimes(part.times, first.times))) {
    return [first.times, ...parts.map((part) => part.values)];
  }
  return merged(parts);
}

// The number of the first sample at or after a time; one sample before it is kept, so that lines reach the
// edge.
export function firstAt(times: readonly number[], from: number): number {
  let low = 0;
  let high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((times[middle] as number) < from) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return Math.max(0, low - 1);
}

// Streams of one run are sampled at the same ticks, so that equal ends mean equal times.
function sameTimes(one: readonly number[], other: readonly number[]): boolean {
  return (
    one.length === other.length && one[0] === other[0] && one[one.length - 1] === other[other.length - 1]
  );
}

function merged(parts: readonly Samples[]): Traces {
  const times: number[] = [];
  const columns: (number | null)[][] = parts.map(() => []);
  const next = parts.map(() => 0);
  for (;;) {
    let time = Infinity;
    parts.forEach((part, i) => (time = Math.min(time, part.times[next[i] as number] ?? Infinity)));
    if (time === Infinity) {
      return [times, ...columns];
    }
    times.push(time);
    parts.forEach((part, i) => {
      const at = next[i] as number;
      const hit = part.times[at] === time;
      columns[i]?.push(hit ? (part.values[at] ?? null) : null);
      next[i] = hit ? at + 1 : at;
    });
  }
}
