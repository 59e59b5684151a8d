// Values of parameters as the document writes them, addressed by paths such as kernel.0.sigma.

export type Values = Record<string, unknown>;

export function valueAt(values: unknown, path: string): unknown {
  return path
    .split(".")
    .reduce<unknown>((inner, step) => (isHolder(inner) ? inner[step] : undefined), values);
}

// Whether a text has every word that was typed.
export function hasWords(text: string, typed: string): boolean {
  return typed
    .toLowerCase()
    .split(/\s+/)
    .every((word) => text.toLowerCase().includes(word));
}

// Items by a key, in the order in which the keys first occur.
export function grouped<T>(items: readonly T[], keyOf: (item: T) => string): [string, T[]][] {
  const groups = new Map<string, T[]>();
  for (const item of items) {
    const members = groups.get(keyOf(item)) ?? [];
    members.push(item);
    groups.set(keyOf(item), members);
  }
  return [...groups];
}

function isHolder(value: unknown): value is Values {
  return typeof value === "object" && value !== null;
}
