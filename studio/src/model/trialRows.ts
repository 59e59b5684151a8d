// The rows of trials as columns, and the distribution of a column in each combination of levels.

import { grouped } from "./values";
import { numberText } from "./number";

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
  const column = (name: string, sort: Column["sort"], of: (row: TrialRow) => unknown): Column => ({
    name,
    sort,
    of: (row) => (of(row) ?? null) as Cell,
  });
  return [
    ...Object.keys(first.levels).map((name) => column(name, "level", ({ levels }) => levels[name])),
    column("outcome", "text", ({ outcome }) => outcome),
    column("duration", "number", ({ duration }) => duration),
    ...Object.keys(first.events).map((name) => column(name, "number", ({ events }) => events[name])),
    ...Object.keys(first.measures).flatMap((name) => {
      const count = several(name);
      return count === 0
        ? [column(name, "number", ({ measures }) => measures[name])]
        : Array.from({ length: count }, (_, i) =>
            column(`${name}.${i}`, "number", ({ measures }) => (measures[name] as number[] | null)?.[i]),
          );
    }),
    ...(rows.some(({ machine }) => machine !== undefined)
      ? [column("machine", "level", ({ machine }) => machine)]
      : []),
  ];
}

// `label` names factors and levels, `short` the levels alone.
export type Condition = { label: string; short: string; rows: TrialRow[] };

// The rows of each combination of levels, in the order of the trials.
export function conditionsOf(rows: readonly TrialRow[]): Condition[] {
  const labelOf = ({ levels }: TrialRow) =>
    Object.entries(levels)
      .map(([name, level]) => `${name} ${cellText(level)}`)
      .join(", ");
  return grouped(rows, labelOf).map(([label, members]) => ({
    label,
    short: Object.values(members[0]?.levels ?? {})
      .map(cellText)
      .join(", "),
    rows: members,
  }));
}

export function cellText(cell: Cell): string {
  return cell === null ? "" : typeof cell === "number" ? numberText(cell) : cell;
}

const BINS = 24;

// The range of all values; one value gets some space around it.
export function rangeOf(values: readonly number[]): [number, number] {
  if (values.length === 0) {
    return [0, 1];
  }
  const lower = values.reduce((a, b) => Math.min(a, b));
  const upper = values.reduce((a, b) => Math.max(a, b));
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
