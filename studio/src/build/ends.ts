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
