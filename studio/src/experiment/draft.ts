// The plain data of an experiment, and its changes: each returns new data.

import { fresh, same } from "../model/part";
import type { Kind, ParameterForm } from "../protocol";
import type { Values } from "../model/values";

export type Data = Record<string, unknown>;
export type Group = "conditions" | "actions" | "factors" | "measures";
export type Part = { key: string; values: Values };

// The parts of a group with their names; an action, which has none, with its number.
export function partsOf(data: Data, group: Group): Part[] {
  const held = data[group];
  if (Array.isArray(held)) {
    return (held as Values[]).map((values, i) => ({ key: String(i), values }));
  }
  return Object.entries((held ?? {}) as Record<string, Values>).map(([key, values]) => ({ key, values }));
}

export function omitted(values: Values, name: string): Values {
  return Object.fromEntries(Object.entries(values).filter(([key]) => key !== name));
}

function mapParts(data: Data, group: Group, change: (part: Part) => Part): Data {
  return withParts(data, group, partsOf(data, group).map(change));
}

function withParts(data: Data, group: Group, parts: Part[]): Data {
  if (parts.length === 0) {
    return omitted(data, group);
  }
  const held =
    group === "actions"
      ? parts.map(({ values }) => values)
      : Object.fromEntries(parts.map(({ key, values }) => [key, values]));
  return { ...data, [group]: held };
}

// All names of columns, which are unique in an experiment.
export function names(data: Data): string[] {
  return (["conditions", "factors", "measures"] as const).flatMap((group) =>
    partsOf(data, group).map(({ key }) => key),
  );
}

export function add(data: Data, group: Group, values: Values, name: string): Data {
  const key = fresh([...names(data), "outcome", "time", "trial"], name);
  return withParts(data, group, [...partsOf(data, group), { key, values }]);
}

export function put(data: Data, group: Group, key: string, values: Values): Data {
  return mapParts(data, group, (part) => (part.key === key ? { key, values } : part));
}

export function remove(data: Data, group: Group, key: string): Data {
  const rest = partsOf(data, group).filter((part) => part.key !== key);
  return withParts(data, group, rest);
}

// Another name for a part, at its place; parts that name an event follow it.
export function rename(data: Data, group: Group, key: string, name: string, kinds: Kind[]): Data {
  const next = mapParts(data, group, (part) => (part.key === key ? { ...part, key: name } : part));
  if (group !== "conditions") {
    return next;
  }
  const swap = (value: unknown): unknown =>
    Array.isArray(value) ? value.map(swap) : value === key ? name : value;
  return (["conditions", "actions", "measures"] as const).reduce(
    (out, each) =>
      mapParts(out, each, ({ key: at, values }) => ({
        key: at,
        values: mapped(values, (value, field) =>
          formOf(kinds, values, field)?.names === "event" ? swap(value) : value,
        ),
      })),
    next,
  );
}

function formOf(kinds: Kind[], values: Values, field: string): ParameterForm | undefined {
  const kind = kinds.find(({ name }) => name === values["kind"]) ?? kinds.at(-1);
  return kind?.parameters.find(({ name }) => name === field);
}

// Set a parameter by its path below a part, such as near or near.1; a default is not stored.
export function setAt(values: Values, forms: ParameterForm[], path: string, value: unknown): Values {
  const [head = "", index] = path.split(".");
  const form = forms.find(({ name }) => name === head);
  const whole =
    index === undefined
      ? value
      : ((values[head] ?? form?.default ?? []) as unknown[]).map((v, i) => (i === Number(index) ? value : v));
  return whole === null || same(whole, form?.default) ? omitted(values, head) : { ...values, [head]: whole };
}

// ------------------------------------------------------------------------------------------- levels

export type NamedLevels = Record<string, Values>;

export function isNamed(levels: unknown): levels is NamedLevels {
  return typeof levels === "object" && levels !== null && !Array.isArray(levels);
}

// The parameters that named levels set, in the order of their first occurrence.
export function pathsOf(levels: NamedLevels): string[] {
  return [...new Set(Object.values(levels).flatMap((level) => Object.keys(level)))];
}

export function mapped<T>(
  values: Record<string, T>,
  change: (value: T, name: string) => T,
): Record<string, T> {
  return Object.fromEntries(Object.entries(values).map(([name, value]) => [name, change(value, name)]));
}

// Set a parameter in one level, if there still is such a level.
export function withNumber(levels: NamedLevels, label: string, path: string, value: unknown): NamedLevels {
  const level = levels[label];
  return level === undefined ? levels : { ...levels, [label]: { ...level, [path]: value } };
}
