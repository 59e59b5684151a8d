// The rows of trials as columns, and the distribution of a column in each combination of levels.

import { numberText } from "../widgets/number";

export type TrialRow = {
  trial: number;
  levels: Record<string, string | number>;
  outcome: string;
  awaited: string;
  duration: number | null;
  events: Record<string, number | null>;
  measures: Record<string, number | number[] | null>;
  // Of a run on mixed machines.
  machine?: string;
};

export type Cell = string | number | null;
export type Column = { name: string; sort: "level" | "text" | "number"; of: (row: TrialRow) => Cell };

// The columns of the table; a measure of several numbers has one for each.
export function columnsOf(rows: readonly TrialRow[]): Column[] {
  const first = rows[0];
  if (first === undefined) {
    return [];
  }
  const several = (name: string) =>
    Math.max(...rows.map(({ measures }) => (Array.isArray(measures[name]) ? measures[name].length : 0)));
  return [
    ...Object.keys(first.levels).map((name): Column => ({
      name,
      sort: "level",
      of: ({ levels }) => levels[name] ?? null,
    })),
    { name: "outcome", sort: "text", of: ({ outcome }) => outcome },
    { name: "duration", sort: "number", of: ({ duration }) => duration },
    ...Object.keys(first.events).map((name): Column => ({
      name,
      sort: "number",
      of: ({ events }) => events[name] ?? null,
    })),
    ...Object.keys(first.measures).flatMap((name): Column[] => {
      const count = several(name);
      if (count === 0) {
        return [{ name, sort: "number", of: ({ measures }) => measures[name] as number | null }];
      }
      return Array.from({ length: count }, (_, i) => ({
        name: `${name}.${i}`,
        sort: "number",
        of: ({ measures }) => (measures[name] as number[] | null)?.[i] ?? null,
      }));
    }),
    ...(rows.some(({ machine }) => machine !== undefined)
      ? [{ name: "machine", sort: "level", of: ({ machine }) => machine ?? null } satisfies Column]
      : []),
  ];
}

// `label` names factors and levels, `short` the levels alone.
export type Condition = { label: string; short: string; rows: TrialRow[] };

// The rows of each combination of levels, in the order of the trials.
export function conditionsOf(rows: readonly TrialRow[]): Condition[] {
  const found = new Map<string, Condition>();
  for (const row of rows) {
    const label = Object.entries(row.levels)
      .map(([name, level]) => `${name} ${cellText(level)}`)
      .join(", ");
    const condition = found.get(label) ?? {
      label,
      short: Object.values(row.levels).map(cellText).join(", "),
      rows: [],
    };
    condition.rows.push(row);
    found.set(label, condition);
  }
  return [...found.values()];
}

export function cellText(cell: Cell): string {
  return cell === null ? "" : typeof cell === "number" ? numberText(cell) : cell;
}

const BINS = 24;

// The range of all values; one value gets some space around it.
export function rangeOf(values: readonly number[]): [number, number] {
  const [lower, upper] = values.reduce(
    ([low, high], value) => [Math.min(low, value), Math.max(high, value)],
    [Infinity, -Infinity],
  );
  if (lower > upper) {
    return [0, 1];
  }
  const some = lower === upper ? Math.max(Math.abs(lower) / 10, 0.5) : 0;
  return [lower - some, upper + some];
}

export function bins(values: readonly number[], [lower, upper]: [number, number], count = BINS): number[] {
  const counts = Array.from({ length: count }, () => 0);
  for (const value of values) {
    const k = Math.min(count - 1, Math.floor(((value - lower) / (upper - lower)) * count));
    counts[k] = (counts[k] ?? 0) + 1;
  }
  return counts;
}

export function median(values: readonly number[]): number | null {
  const sorted = [...values].sort((a, b) => a - b);
  const half = sorted.length / 2;
  const [low, high] = [sorted[Math.ceil(half) - 1], sorted[Math.floor(half)]];
  return low === undefined || high === undefined ? null : (low + high) / 2;
}

// How often each text occurs, in the order of `texts`.
export function shares(values: readonly Cell[], texts: readonly string[]): number[] {
  return texts.map((text) => values.filter((value) => value === text).length);
}
