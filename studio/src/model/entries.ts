// What a chooser lists: entries by family, found by typed words.

import type { Kind, TemplateView } from "../protocol";
import type { Values } from "./values";

export type ListEntry = {
  id: string;
  family: string;
  title: string;
  // At the end of the line: keys, a path.
  note?: string;
  // Further words that the search finds.
  words?: string;
  // The kind whose sketch and equation are shown.
  kind?: Kind;
  // The values of the new element, where the entry states some.
  values?: () => Values;
  // The name of the new element, where it is not that of the kind.
  called?: string;
  // The model whose picture and sentence are shown.
  template?: TemplateView;
  // The element that the entry is about.
  element?: string;
  // Why the entry cannot be chosen.
  why?: string;
  run?: () => unknown;
};

// The entries that contain every word, in the order of their families; the best match of all is `best`.
export function search(text: string, entries: ListEntry[]): { found: ListEntry[]; best: ListEntry | null } {
  const words = text
    .toLowerCase()
    .split(/\s+/)
    .filter((word) => word !== "");
  const ranked = entries.flatMap((entry, order) => {
    const rank = rankOf(entry, words);
    return rank === null ? [] : [{ entry, order, rank: rank + (entry.why === undefined ? 0 : 100) }];
  });
  const families = [...new Set(entries.map((entry) => entry.family))];
  const bestOf = new Map<string, number>();
  for (const { entry, rank } of ranked) {
    bestOf.set(entry.family, Math.min(rank, bestOf.get(entry.family) ?? Infinity));
  }
  // While something is typed, the family with the best match comes first.
  const place = (family: string) =>
    (words.length === 0 ? 0 : (bestOf.get(family) ?? 0) * families.length) + families.indexOf(family);
  ranked.sort(
    (a, b) => place(a.entry.family) - place(b.entry.family) || a.rank - b.rank || a.order - b.order,
  );
  const found = ranked.map(({ entry }) => entry);
  return { found, best: found.find((entry) => entry.why === undefined) ?? null };
}

// The least is best; null: a word does not occur.
function rankOf({ title, family, words = "", note = "" }: ListEntry, typed: string[]): number | null {
  const name = title.toLowerCase();
  const rest = `${family} ${note} ${words}`.toLowerCase();
  let rank = name === typed.join(" ") ? -1 : 0;
  for (const word of typed) {
    const found = [
      name.startsWith(word),
      name.split(/[\s_.]+/).some((part) => part.startsWith(word)),
      name.includes(word),
      rest.split(/[^a-z0-9]+/).some((part) => part.startsWith(word)),
      rest.includes(word),
    ].indexOf(true);
    if (found < 0) {
      return null;
    }
    rank += found;
  }
  return rank;
}
