// Parts as values: their summary in one line, a change of kind, items of a list.

import type { Kind, ParameterForm } from "../protocol";
import type { Values } from "./values";
import type { Kinds } from "./leaf";
import { numberText } from "./number";

// The number of values that are shown in one line.
const MOST = 3;

export function kindOf(kinds: Kinds, part: unknown): Kind | undefined {
  return kinds.get(String((part as Values | null)?.["kind"]));
}

export function summary(kinds: Kinds, part: unknown): string {
  const forms = kindOf(kinds, part)?.parameters ?? [];
  return forms
    .map((form) => [form, (part as Values)[form.name]] as const)
    .filter(
      ([form, value]) =>
        (form.form === "number" || form.form === "integer" || form.form === "per_axis") && value !== null,
    )
    .slice(0, MOST)
    .map(
      ([form, value]) =>
        `${words(form.name)} ${[value]
          .flat()
          .map((v) => numberText(Number(v)))
          .join(" × ")}`,
    )
    .join(", ");
}

// A part of another kind: what both kinds have keeps its value.
export function recast(kinds: Kinds, name: string, old: unknown): Values {
  const kind = kinds.get(name);
  const fresh = { ...((kind?.example ?? { kind: name }) as Values) };
  const before = kindOf(kinds, old)?.parameters ?? [];
  for (const form of kind?.parameters ?? []) {
    if (before.some((p) => p.name === form.name && p.form === form.form && p.unit === form.unit)) {
      fresh[form.name] = (old as Values)[form.name];
    }
  }
  return fresh;
}

// Words of a name: resting_level is read "resting level".
export function words(name: string): string {
  return name.replaceAll("_", " ");
}

// The symbol that an equation has for a parameter; none where that is no more than its name again.
export function symbolOf(form: ParameterForm): string {
  return form.symbol.replaceAll("\\", "") === `mathrm{${form.name}}` || form.symbol === form.name
    ? ""
    : form.symbol;
}

export function without<T>(items: T[], index: number): T[] {
  return items.filter((_, i) => i !== index);
}

export function moved<T>(items: T[], from: number, to: number): T[] {
  const rest = without(items, from);
  const item = items[from];
  return item === undefined || to < 0 || to >= items.length
    ? items
    : [...rest.slice(0, to), item, ...rest.slice(to)];
}

// A name that is not used yet.
export function fresh(taken: string[], name = "name"): string {
  for (let i = 1; ; i++) {
    const candidate = i === 1 ? name : `${name}${i}`;
    if (!taken.includes(candidate)) {
      return candidate;
    }
  }
}

export function same(a: unknown, b: unknown): boolean {
  if (typeof a !== "object" || typeof b !== "object" || a === null || b === null) {
    return a === b || (a ?? null) === (b ?? null);
  }
  const [left, right] = [a as Values, b as Values];
  const keys = Object.keys(left);
  return (
    Array.isArray(a) === Array.isArray(b) &&
    keys.length === Object.keys(right).length &&
    keys.every((key) => key in right && same(left[key], right[key]))
  );
}

// Axes and arrays belong to a document: a kind has no default for them that would fit in.
export function hasDefault(form: ParameterForm): boolean {
  return !["axes", "axis", "array"].includes(form.form) && form.default !== undefined;
}
