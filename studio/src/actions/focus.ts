// What a contracted architecture brings to the fore: the boxes around the one below the pointer, or around
// what is selected. All others are faint.

import { useEffect } from "react";
import { create } from "zustand";
import { usePicked } from "./picked";
import { useStudio } from "../server/store";
import type { GraphScene } from "../architecture/scene";
import type { Chain } from "../architecture/chains";

// `near` is null where nothing is brought to the fore. `wire`: the one below the pointer; `changed`: the one
// whose strength has the focus.
type Focus = {
  hovered: string | null;
  near: ReadonlySet<string> | null;
  wire: string | null;
  changed: string | null;
  // The connections on the canvas that are one chain, by the ids of their wires.
  chains: ReadonlyMap<string, Chain>;
};

export const useFocus = create<Focus>(() => ({
  hovered: null,
  near: null,
  wire: null,
  changed: null,
  chains: new Map(),
}));

// The pointer goes from a wire to what is drawn on it.
const LEAVE_MS = 120;
let leaving = 0;

export function overWire(wire: string | null): void {
  clearTimeout(leaving);
  if (wire === null) {
    leaving = window.setTimeout(() => useFocus.setState({ wire }), LEAVE_MS);
  } else {
    useFocus.setState({ wire });
  }
}

export function unhover(id: string): void {
  if (useFocus.getState().hovered === id) {
    useFocus.setState({ hovered: null });
  }
}

// The boxes that these elements and wires are joined with.
export function nearOf(links: ReadonlyMap<string, ReadonlySet<string>>, ids: string[]): Set<string> {
  return new Set(ids.flatMap((id) => [id, ...(links.get(id) ?? [])]));
}

// Keeps `near` and `chains`. It follows the stores past React, which would draw the whole canvas again for
// each box below the pointer.
export function useNear({ links, wires }: GraphScene, changed: () => void): void {
  useEffect(() => {
    const single = wires.flatMap(({ id, data }) => {
      const [chain, ...others] = data?.chains ?? [];
      return chain === undefined || others.length > 0 ? [] : [[id, chain] as const];
    });
    useFocus.setState({ chains: new Map(single) });
  }, [wires]);
  useEffect(() => {
    if (links === null) {
      return;
    }
    const follow = () => {
      const { hovered } = useFocus.getState();
      const chosen = [...useStudio.getState().selected, ...usePicked.getState().wires];
      const known = (hovered === null ? chosen : [hovered]).filter((id) => links.has(id));
      useFocus.setState({ near: known.length === 0 ? null : nearOf(links, known) });
      changed();
    };
    follow();
    const leave = [
      useStudio.subscribe((state, before) => state.selected !== before.selected && follow()),
      usePicked.subscribe((state, before) => state.wires !== before.wires && follow()),
      useFocus.subscribe((state, before) => state.hovered !== before.hovered && follow()),
    ];
    return () => {
      leave.forEach((end) => end());
      useFocus.setState({ near: null });
    };
  }, [links, changed]);
}
