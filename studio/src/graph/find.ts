// Finds elements by typed words: parts of the path, the name, or the kind.

import type { ElementView, Kind } from "../protocol";

export type Found = { element: string; path: string; title: string };

const MOST = 50;

// Every word must occur; names that begin with the typed text come first.
export function find(text: string, elements: ElementView[], kinds: Map<string, Kind>): Found[] {
  const words = text
    .toLowerCase()
    .split(/\s+/)
    .filter((word) => word !== "");
  return elements
    .map((e) => ({
      element: e.id,
      path: e.path,
      title: kinds.get(e.kind)?.title ?? e.kind,
      name: e.name.toLowerCase(),
      kind: e.kind,
    }))
    .filter(({ path, title, kind }) =>
      words.every((word) => `${path} ${title} ${kind}`.toLowerCase().includes(word)),
    )
    .map((found) => ({ found, rank: rank(found.name, words) }))
    .sort((a, b) => a.rank - b.rank || a.found.path.localeCompare(b.found.path))
    .slice(0, MOST)
    .map(({ found: { element, path, title } }) => ({ element, path, title }));
}

function rank(name: string, [first = ""]: string[]): number {
  return name === first ? 0 : name.startsWith(first) ? 1 : name.includes(first) ? 2 : 3;
}
