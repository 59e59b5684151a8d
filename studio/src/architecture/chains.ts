// Couplings that are drawn on an edge: those in a chain, with one connection in and one out.

import type { ConnectionView, DocumentView, ElementView, Kind } from "../protocol";
import { isUnnamed } from "./label";
import { product, type Sign } from "./sign";

// A connection as it is drawn: from a node to a node, with the couplings on the way in their order. `gain`:
// the one that is the strength of the connection alone; the id is the same without it.
export type Chain = {
  id: string;
  source: string;
  source_port: string;
  target: string;
  target_port: string;
  couplings: string[];
  gain: string | null;
  reads: string;
  sign: Sign;
};

type Unsigned = Omit<Chain, "sign" | "gain">;

export type Chains = { edges: Chain[]; couplings: Set<string> };

type Wired = Pick<DocumentView, "elements" | "connections">;

// The edges of the canvas, and the couplings that are drawn on them.
export function chains(document: Wired, kinds: Map<string, Kind>): Chains {
  const known = new Map(document.elements.map((e) => [e.id, e]));
  const connections = document.connections.filter((c) => known.has(c.source) && known.has(c.target));
  const into = by(connections, "target");
  const from = by(connections, "source");
  const links = new Set(
    document.elements
      .filter(
        (e) =>
          e.inputs.length === 1 &&
          e.outputs.length === 1 &&
          isWeight(e, kinds.get(e.kind)) &&
          into.get(e.id)?.length === 1 &&
          from.get(e.id)?.length === 1,
      )
      .map((e) => e.id),
  );
  const edges: Unsigned[] = [];
  const couplings = new Set<string>();
  for (const first of connections) {
    if (!links.has(first.source)) {
      edges.push(follow(first, links, from, couplings));
    }
  }
  // The remaining couplings form rings without a node to begin at, so each becomes a node.
  for (const lone of connections.filter((c) => links.has(c.source) && !couplings.has(c.source))) {
    edges.push(edge(lone, lone, [], lone.reads));
  }
  const ids = new Set(edges.map(({ id }) => id));
  return {
    edges: edges.map((edge) => {
      const gain = gainOf(edge.couplings, known);
      const rest = edge.couplings.filter((coupling) => coupling !== gain);
      const without = [endsId(edge), ...rest].join(" ");
      const id = ids.has(without) ? edge.id : without;
      ids.add(id);
      return { ...edge, id, gain, sign: signOf(edge, known, kinds) };
    }),
    couplings,
  };
}

// The last Gain without a name of its own.
export function gainOf(couplings: string[], elements: Map<string, ElementView>): string | null {
  return (
    couplings.findLast((id) => {
      const { name = "", kind = "" } = elements.get(id) ?? {};
      return kind === "Gain" && isUnnamed(name, kind);
    }) ?? null
  );
}

// An input of a coupling with a box is a number, which inhibits nothing.
function signOf(
  { source, target, couplings }: Unsigned,
  elements: Map<string, ElementView>,
  kinds: Map<string, Kind>,
): Sign {
  const room = (id: string) => kinds.get(elements.get(id)?.kind ?? "")?.room;
  const weighting =
    couplings.length === 0 && room(target) === "couplings" && room(source) !== "couplings"
      ? couplings
      : [source, ...couplings];
  return weighting.map((id) => elements.get(id)?.effect ?? "+").reduce(product, "+");
}

function follow(
  first: ConnectionView,
  links: Set<string>,
  from: Map<string, ConnectionView[]>,
  passed: Set<string>,
): Unsigned {
  const on: string[] = [];
  let last = first;
  let reads = first.reads;
  while (links.has(last.target)) {
    on.push(last.target);
    passed.add(last.target);
    last = from.get(last.target)?.[0] as ConnectionView;
    reads = later(reads, last.reads);
  }
  return edge(first, last, on, reads);
}

function edge(first: ConnectionView, last: ConnectionView, couplings: string[], reads: string): Unsigned {
  const { source, source_port } = first;
  const { target, target_port } = last;
  const ends = { source, source_port, target, target_port };
  return { id: [endsId(ends), ...couplings].join(" "), ...ends, couplings, reads };
}

const endsId = (ends: Omit<Unsigned, "id" | "couplings" | "reads">): string =>
  [ends.source, ends.source_port, ends.target, ends.target_port].join(" ");

// Kinds of other packages do not declare whether they are couplings: one with its own axes or levels gets a
// box.
export function isWeight(element: ElementView, kind: Kind | undefined): boolean {
  if (kind === undefined || kind.room === "couplings") {
    return kind !== undefined;
  }
  const isAlone = element.inputs.length === 1 && element.outputs.length === 1;
  const own =
    isAlone && kind.room === "own" && element.inputs[0] === "input" && element.outputs[0] === "output";
  return own && Object.keys(kind.levels).length === 0 && !kind.parameters.some((p) => p.form === "axes");
}

const LATER = ["", "current", "previous", "delayed"];

export function later(one: string, other: string): string {
  return LATER.indexOf(other) > LATER.indexOf(one) ? other : one;
}

// The connections at one of their ends.
export function by(connections: ConnectionView[], end: "source" | "target"): Map<string, ConnectionView[]> {
  const table = new Map<string, ConnectionView[]>();
  for (const connection of connections) {
    const found = table.get(connection[end]);
    if (found === undefined) {
      table.set(connection[end], [connection]);
    } else {
      found.push(connection);
    }
  }
  return table;
}
