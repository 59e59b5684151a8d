// The connections on the canvas, and their meaning in the document.

import type { Chain } from "../graph/chains";
import { useStudio } from "../store";
import { type WireEnds, endsOf } from "./ends";
import { getStage } from "./stage";

function chainsOf(wire: string): Chain[] {
  return (
    getStage()
      ?.scene()
      .wires.find(({ id }) => id === wire)?.data?.chains ?? []
  );
}

// What is removed with a connection on the canvas: the couplings on it, or else the connection.
export function contentOf(wire: string): { elements: string[]; connections: WireEnds[] } {
  const chains = chainsOf(wire);
  return {
    elements: chains.flatMap((chain) => chain.couplings),
    connections: chains.filter((chain) => chain.couplings.length === 0).map(endsOf),
  };
}

// The first connection of one on the canvas, into which an element can be inserted. Null for several in one.
export function firstOf(wire: string): WireEnds | null {
  const [chain, ...others] = chainsOf(wire);
  if (chain === undefined || others.length > 0) {
    return null;
  }
  const next = chain.couplings[0];
  const found = useStudio
    .getState()
    .document?.connections.find(
      (c) =>
        c.source === chain.source &&
        c.source_port === chain.source_port &&
        (next === undefined
          ? c.target === chain.target && c.target_port === chain.target_port
          : c.target === next),
    );
  return found === undefined ? null : endsOf(found);
}

// The connection on the canvas at a position of the screen.
export function wireAt(x: number, y: number): string | null {
  for (const element of document.elementsFromPoint(x, y)) {
    const edge = element.closest(".react-flow__edge");
    if (edge !== null) {
      return edge.getAttribute("data-id");
    }
    if (element.closest(".react-flow__node") !== null) {
      return null;
    }
  }
  return null;
}
