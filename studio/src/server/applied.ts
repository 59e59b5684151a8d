// An object or a list after a difference: what did not change stays the same object.

import type { KeyedDifference } from "../protocol";

export function applied<T>(before: T, { inside = {}, removed = [], changed = {} }: KeyedDifference): T {
  const entries = new Map<string, unknown>(Object.entries(before as object));
  Object.entries(inside).forEach(([key, part]) => entries.set(key, applied(entries.get(key), part)));
  removed.forEach((key) => entries.delete(key));
  if (!Array.isArray(before)) {
    return { ...Object.fromEntries(entries), ...changed } as T;
  }
  const list = [...entries.values()];
  Object.entries(changed).forEach(([index, entry]) => list.splice(Number(index), 0, entry));
  return list as T;
}
