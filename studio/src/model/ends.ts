// The ends of connections.

import type { ConnectionView } from "../protocol";

export type Side = "source" | "target";

export type End = { element: string; port: string };

export type WireEnds = Pick<ConnectionView, "source" | "source_port" | "target" | "target_port">;

export const endsOf = ({ source, source_port, target, target_port }: WireEnds): WireEnds => ({
  source,
  source_port,
  target,
  target_port,
});

// The connection between two ports, from the one at which it was begun.
export function between(from: End, side: Side, to: End): WireEnds {
  const [source, target] = side === "source" ? [from, to] : [to, from];
  return {
    source: source.element,
    source_port: source.port,
    target: target.element,
    target_port: target.port,
  };
}

// The element and its port at a handle; the handles of a folded group name those inside.
export function endAt(node: string, handle: string | null): { element: string; port: string | null } {
  const gap = handle?.indexOf(" ") ?? -1;
  return node.startsWith("group:") && handle !== null && gap >= 0
    ? { element: handle.slice(0, gap), port: handle.slice(gap + 1) }
    : { element: node, port: handle };
}
