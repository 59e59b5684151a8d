// Finds elements by typed words: parts of the path, the name, or the kind.

import type { ElementView, Kind } from "../protocol";

export type Found = { element: string; path: string; title: string };

const MOST = 50;

// Every word must occur; the name that is the typed text comes first, then those that begin with it.
export function find(text: string, elements: ElementView[], kinds: Map<string, Kind>): Found[] {
  const typed = text.trim().toLowerCase().replace(/\s+/g, " ");
  const words = typed.split(" ").filter((word) => word !== "");
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
    .map((found) => ({
      found,
      rank: Math.min(rank(found.name, typed), 3 + rank(found.name, words[0] ?? "")),
    }))
    .sort((a, b) => a.rank - b.rank || a.found.path.localeCompare(b.found.path))
    .slice(0, MOST)
    .map(({ found: { element, path, title } }) => ({ element, path, title }));
}

function rank(name: string, text: string): number {
  return name === text ? 0 : name.startsWith(text) ? 1 : name.includes(text) ? 2 : 3;
}
