// Large architectures without their small parts: couplings are drawn on the wires between boxes, stimuli as
// dots in the boxes that they feed, and the coupling of a box to itself as a badge on it. Elements that a
// person has placed stay boxes.

import type { ConnectionView, DocumentView, ElementView, Kind } from "../protocol";
import { isGrid } from "./grid";
import { by, type Chain, gainOf, isWeight, later } from "./chains";
import { product, together, type Sign } from "./sign";

// What the arrangement of a canvas depends on.
export type Structure = Pick<DocumentView, "elements" | "connections" | "groups" | "layout">;

type WireEnding = Pick<ConnectionView, "source" | "source_port" | "target" | "target_port">;

// What only this wire has: it is removed with it. Couplings of other wires are none of it.
export type WireContent = { elements: string[]; connections: WireEnding[] };

// `isChain`: its couplings follow each other, and belong to no other wire.
export type BoxLink = Chain & { content: WireContent; isChain: boolean };

// A coupling of more pairs of elements is a box.
const MOST_PAIRS = 8;

type Bare = Omit<BoxLink, "content" | "isChain">;

export type Contraction = {
  boxes: string[];
  edges: BoxLink[];
  // By box, the elements that it shows as dots, and those that couple it to itself.
  dots: Map<string, string[]>;
  badges: Map<string, string[]>;
  // All elements without a box.
  couplings: Set<string>;
};

// Null where all elements are drawn: in small documents, in those whose names form no grid, in those with
// groups, which fold instead, and where a person wants to see every element.
export function contract(structure: Structure, kinds: Map<string, Kind>): Contraction | null {
  const { boxes, every_element } = structure.layout;
  return every_element ? null : contracted(structure, kinds, new Set(Object.keys(boxes)));
}

// The same whatever a person wants to see or has placed; null where nothing can be contracted.
export const contractionIn = (structure: Structure, kinds: Map<string, Kind>): Contraction | null =>
  contracted(structure, kinds, new Set());

function contracted(structure: Structure, kinds: Map<string, Kind>, placed: Set<string>): Contraction | null {
  const { elements, groups } = structure;
  if (groups.length > 0 || elements.some(({ group }) => group.length > 0)) {
    return null;
  }
  const contraction = contractAll(structure, kinds, placed);
  const boxes = new Set(contraction.boxes);
  const names = elements.filter(({ id }) => boxes.has(id)).map(({ name }) => name);
  return contraction.couplings.size > 0 && isGrid(names) ? contraction : null;
}

// `placed`: elements that stay boxes.
export function contractAll(
  { elements, connections }: Pick<Structure, "elements" | "connections">,
  kinds: Map<string, Kind>,
  placed: Set<string>,
): Contraction {
  const parts = new Set(
    elements
      .filter((e) => !placed.has(e.id) && (e.inputs.length === 0 || isWeight(e, kinds.get(e.kind))))
      .map((e) => e.id),
  );
  const net = netOf(elements, connections);
  // What joins many boxes with many is drawn once, not as a wire for each pair of them.
  for (const id of parts) {
    const [read, fed] = [net.into.get(id)?.length ?? 0, net.from.get(id)?.length ?? 0];
    if (read > 1 && fed > 1 && read * fed > MOST_PAIRS) {
      parts.delete(id);
    }
  }
  // A part without a box at any side of it, or in a ring of its own, is a box itself.
  for (const { id } of elements) {
    if (parts.has(id) && ends(net, id, parts).length === 0) {
      parts.delete(id);
    }
  }
  const boxes = elements.filter(({ id }) => !parts.has(id)).map(({ id }) => id);
  const links: Bare[] = [];
  const [dots, badges] = [new Map<string, string[]>(), new Map<string, string[]>()];
  const drawn = new Set<string>();
  const from = new Map(boxes.map((id) => [id, reach(net.from, id, parts, "target")]));
  const into = new Map(boxes.map((id) => [id, reach(net.into, id, parts, "source")]));
  for (const source of boxes) {
    const after = from.get(source) ?? NOWHERE;
    for (const target of after.boxes) {
      const before = into.get(target) ?? NOWHERE;
      const via = after.parts.filter((id) => before.has.has(id));
      via.forEach((id) => drawn.add(id));
      links.push(link(net, source, target, via));
      if (source === target && via.length > 0) {
        badges.set(source, via);
      }
    }
  }
  // Stimuli and what weights them belong to the boxes that they feed; what feeds nothing, to those it reads.
  for (const { id } of elements) {
    if (parts.has(id) && !drawn.has(id)) {
      for (const box of ends(net, id, parts)) {
        dots.set(box, [...(dots.get(box) ?? []), id]);
      }
    }
  }
  const streams = elements.filter(({ id, inputs }) => parts.has(id) && inputs.length === 0);
  const edges = withContent(
    links,
    streams.map(({ id }) => streamOf(net, id, parts)),
    net,
  );
  const isBadge = ({ source, target, couplings }: BoxLink) => source === target && couplings.length > 0;
  return { boxes, edges: edges.filter((one) => !isBadge(one)), dots, badges, couplings: parts };
}

type Net = {
  elements: Map<string, ElementView>;
  into: Map<string, ConnectionView[]>;
  from: Map<string, ConnectionView[]>;
};

// The boxes that are reached through parts alone, and these parts, the nearest first.
type Reach = { boxes: string[]; parts: string[]; has: Set<string> };

const NOWHERE: Reach = { boxes: [], parts: [], has: new Set() };

function netOf(elements: ElementView[], connections: ConnectionView[]): Net {
  const known = new Map(elements.map((e) => [e.id, e]));
  const within = connections.filter((c) => known.has(c.source) && known.has(c.target));
  return {
    elements: known,
    into: by(within, "target"),
    from: by(within, "source"),
  };
}

function reach(
  next: Map<string, ConnectionView[]>,
  start: string,
  parts: Set<string>,
  side: "source" | "target",
): Reach {
  const [boxes, has] = [new Set<string>(), new Set<string>()];
  const front = [start];
  for (let at = front.shift(); at !== undefined; at = front.shift()) {
    for (const { [side]: id } of next.get(at) ?? []) {
      if (!parts.has(id)) {
        boxes.add(id);
      } else if (!has.has(id)) {
        has.add(id);
        front.push(id);
      }
    }
  }
  return { boxes: [...boxes], parts: [...has], has };
}

// The boxes that a part feeds, or else those that it reads.
function ends(net: Net, part: string, parts: Set<string>): string[] {
  const fed = reach(net.from, part, parts, "target").boxes;
  return fed.length > 0 ? fed : reach(net.into, part, parts, "source").boxes;
}

// The connections of all ways from a box to another one through these couplings.
function waysOf(net: Net, { source, target, couplings }: Pick<Bare, "source" | "target" | "couplings">) {
  const inner = new Set(couplings);
  return [source, ...couplings].flatMap((id) =>
    (net.from.get(id) ?? []).filter((c) => inner.has(c.target) || c.target === target),
  );
}

// The connections through which a stimulus reaches boxes.
function streamOf(net: Net, stimulus: string, parts: Set<string>): ConnectionView[] {
  const passed = [stimulus, ...reach(net.from, stimulus, parts, "target").parts];
  return passed.flatMap((id) => net.from.get(id) ?? []);
}

function link(net: Net, source: string, target: string, couplings: string[]): Bare {
  const ways = waysOf(net, { source, target, couplings });
  return {
    id: [source, target, "contracted"].join(" "),
    source,
    source_port: ways.find((c) => c.source === source)?.source_port ?? "",
    target,
    target_port: ways.findLast((c) => c.target === target)?.target_port ?? "",
    couplings,
    gain: gainOf(couplings, net.elements),
    ...weight(net, source, target, ways),
  };
}

// The sign and the delay of all ways from a box to another one together.
function weight(
  net: Net,
  source: string,
  target: string,
  ways: ConnectionView[],
): Pick<Chain, "sign" | "reads"> {
  const effect = (id: string): Sign => net.elements.get(id)?.effect ?? "+";
  const signs = new Map<string, Sign>([[source, effect(source)]]);
  const reads = new Map<string, string>([[source, ""]]);
  // Ways are in the order of their distance, so that one more round is needed for each that leads back.
  for (let changed = true; changed;) {
    changed = false;
    for (const { source: at, target: to, reads: step } of ways) {
      const [sign, read] = [signs.get(at), reads.get(at)];
      if (sign === undefined || read === undefined) {
        continue;
      }
      const own = to === target ? sign : product(sign, effect(to));
      const [known, latest] = [signs.get(to), reads.get(to) ?? ""];
      const [next, time] = [
        known === undefined ? own : together(known, own),
        later(latest, later(read, step)),
      ];
      if (to !== source && (next !== known || time !== latest)) {
        signs.set(to, next);
        reads.set(to, time);
        changed = true;
      }
    }
  }
  return { sign: signs.get(target) ?? "+", reads: reads.get(target) ?? "" };
}

// A coupling or a connection that several wires share, or a wire and a stimulus, belongs to none of them.
function withContent(links: Bare[], streams: ConnectionView[][], net: Net): BoxLink[] {
  const keyOf = (c: WireEnding) => [c.source, c.source_port, c.target, c.target_port].join(" ");
  const uses = new Map<string, number>();
  for (const ways of [...links.map((one) => waysOf(net, one)), ...streams]) {
    for (const key of new Set(ways.map(keyOf))) {
      uses.set(key, (uses.get(key) ?? 0) + 1);
    }
  }
  return links.map((one) => {
    const ways = waysOf(net, one);
    const own = new Set(ways.map(keyOf).filter((key) => uses.get(key) === 1));
    const isOwn = (id: string) =>
      [...(net.from.get(id) ?? []), ...(net.into.get(id) ?? [])].every((c) => own.has(keyOf(c)));
    const elements = one.couplings.filter(isOwn);
    const rest = ways.filter((c) => own.has(keyOf(c)));
    const connections = rest.filter((c) => !elements.includes(c.source) && !elements.includes(c.target));
    const isChain = ways.length === one.couplings.length + 1 && elements.length === one.couplings.length;
    return { ...one, content: { elements, connections }, isChain };
  });
}
