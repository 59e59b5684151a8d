// The connections on the canvas, and their meaning in the document.

import type { WireContent } from "../architecture/contract";
import type { Point } from "../model/rects";
import type { WireData } from "../architecture/nodes";
import type { Chain } from "../architecture/chains";
import { useStudio } from "../server/store";
import { type Side, type WireEnds, endsOf } from "../model/ends";
import { getStage } from "./stage";

const dataOf = (wire: string): WireData | undefined =>
  getStage()
    ?.scene()
    .wires.find(({ id }) => id === wire)?.data;

// Whether a connection is on the canvas: one that was picked may be gone.
export const isDrawn = (wire: string): boolean => dataOf(wire) !== undefined;

const chainsOf = (wire: string): Chain[] => dataOf(wire)?.chains ?? [];

// The middle of a connection on the screen; null: it is not drawn.
export function middleOf(wire: string): Point | null {
  const drawn = getStage()?.around.querySelector(`.react-flow__edge[data-id="${CSS.escape(wire)}"]`);
  const rect = drawn?.getBoundingClientRect();
  return rect === undefined ? null : { x: rect.x + rect.width / 2, y: rect.y + rect.height / 2 };
}

// What is removed with a connection on the canvas: the couplings on it, or else the connection.
export function contentOf(wire: string): WireContent {
  const { chains = [], content = null } = dataOf(wire) ?? {};
  const whole = chains.filter((chain) => chain.couplings.length === 0);
  return {
    elements: content?.elements ?? chains.flatMap((chain) => chain.couplings),
    connections: (content?.connections ?? whole).map(endsOf),
  };
}

// The first connection of one on the canvas, into which an element can be inserted. Null for several in one.
export const firstOf = (wire: string): WireEnds | null => endOf(wire, "source");

// The connection at one end of one on the canvas, which begins or ends at a coupling on it. Null for several
// in one.
export function endOf(wire: string, side: Side): WireEnds | null {
  const [chain, ...others] = chainsOf(wire);
  if (chain === undefined || others.length > 0) {
    return null;
  }
  const [first, last] = [chain.couplings[0], chain.couplings.at(-1)];
  const found = useStudio
    .getState()
    .document?.connections.find((c) =>
      side === "source"
        ? c.source === chain.source &&
          c.source_port === chain.source_port &&
          (first === undefined
            ? c.target === chain.target && c.target_port === chain.target_port
            : c.target === first)
        : c.target === chain.target &&
          c.target_port === chain.target_port &&
          (last === undefined
            ? c.source === chain.source && c.source_port === chain.source_port
            : c.source === last),
    );
  return found === undefined ? null : endsOf(found);
}

// The connection on the canvas at a position of the screen; a box that is dragged does not hide it.
export function wireAt(x: number, y: number, dragged?: string): string | null {
  for (const element of document.elementsFromPoint(x, y)) {
    const edge = element.closest(".react-flow__edge");
    if (edge !== null) {
      return edge.getAttribute("data-id");
    }
    const box = element.closest(".react-flow__node");
    if (
      box !== null &&
      box.getAttribute("data-id") !== dragged &&
      box.closest(".react-flow__node-frame") === null
    ) {
      return null;
    }
  }
  return null;
}
