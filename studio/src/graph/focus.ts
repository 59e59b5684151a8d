// What a contracted architecture brings to the fore: the boxes around the one below the pointer, or around
// what is selected. All others are faint.

import { useEffect } from "react";
import { create } from "zustand";
import { usePicked } from "../build/picked";
import { useStudio } from "../store";
import type { GraphScene } from "./scene";

// `near` is null where nothing is brought to the fore.
type Focus = { hovered: string | null; near: ReadonlySet<string> | null };

export const useFocus = create<Focus>(() => ({ hovered: null, near: null }));

// The boxes that these elements and wires are joined with.
export function nearOf(links: ReadonlyMap<string, ReadonlySet<string>>, ids: string[]): Set<string> {
  return new Set(ids.flatMap((id) => [id, ...(links.get(id) ?? [])]));
}

export function useNear({ links }: GraphScene, changed: () => void): void {
  const selected = useStudio((state) => state.selected);
  const wires = usePicked((state) => state.wires);
  const hovered = useFocus((state) => state.hovered);
  useEffect(() => {
    const ids = hovered === null ? [...selected, ...wires] : [hovered];
    const known = links === null ? [] : ids.filter((id) => links.has(id));
    useFocus.setState({ near: links === null || known.length === 0 ? null : nearOf(links, known) });
    changed();
  }, [links, selected, wires, hovered, changed]);
  useEffect(() => () => useFocus.setState({ hovered: null, near: null }), []);
}
