// A contracted architecture on the canvas: its grid, what boxes and wires show, what belongs together.

import { dimensions } from "./boxes";
import type { Contraction } from "./contract";
import { digitOf, gridPlaces, partsOf } from "./grid";
import { PANEL } from "./layout";
import { meet, type Point, type Rect, type Size } from "../model/rects";
import type { ElementView, Kind } from "../protocol";
import type { SceneNode, Wire } from "./nodes";

// The width of a chip on a wire.
export const CHIP = 22;

type ContractedParts = {
  contraction: Contraction;
  names: Map<string, ElementView>;
  kinds: Map<string, Kind>;
  sizes: Map<string, Size>;
};

// The positions of boxes in the grid. Where a document places most of its boxes there is none: the others
// are placed beside these.
export function inGrid(
  { contraction, names, kinds, sizes }: ContractedParts,
  stored: Map<string, Point>,
  panel: Size = PANEL,
): Map<string, Point> {
  const { boxes, edges, dots } = contraction;
  const free = boxes.filter((id) => !stored.has(id));
  if (free.length <= boxes.length / 2) {
    return new Map();
  }
  const own = free.map((id) => sizes.get(id) ?? { width: 0, height: 0 });
  const size = {
    width: Math.max(...own.map(({ width }) => width)),
    height: Math.max(...own.map(({ height }) => height)),
  };
  const isStimulus = (id: string) => {
    const element = names.get(id);
    const equation = kinds.get(element?.kind ?? "")?.equation.join(" ") ?? "";
    return element?.inputs.length === 0 && dimensions(element) !== 0 && !equation.includes("\\xi");
  };
  const cells = free.map((id) => ({
    id,
    name: names.get(id)?.name ?? "",
    fed: (dots.get(id) ?? []).some(isStimulus),
  }));
  return gridPlaces(cells, edges, size, panel);
}

// A frame around the cells of a grid whose names end in one digit, or in none.
export type CellFrame = Rect & { name: string };

// What a frame keeps around its boxes, with room for its name above them.
const PAD = { side: 16, top: 40, bottom: 16 };

// The frames of a grid; none where they would cover each other, because boxes were moved.
export function cellFrames(boxes: { name: string; rect: Rect }[]): CellFrame[] {
  const digits = new Map<string, { suffix: string; rect: Rect }[]>();
  for (const { name, rect } of boxes.toSorted((a, b) => a.rect.x - b.rect.x)) {
    const { suffix } = partsOf(name);
    digits.set(digitOf(suffix), [...(digits.get(digitOf(suffix)) ?? []), { suffix, rect }]);
  }
  const top = Math.min(...boxes.map(({ rect }) => rect.y)) - PAD.top;
  const bottom = Math.max(...boxes.map(({ rect }) => rect.y + rect.height)) + PAD.bottom;
  const frames = [...digits.values()].map((cells) => {
    const x = Math.min(...cells.map(({ rect }) => rect.x)) - PAD.side;
    const right = Math.max(...cells.map(({ rect }) => rect.x + rect.width)) + PAD.side;
    const names = new Set(cells.map(({ suffix }) => suffix).filter((suffix) => suffix !== ""));
    return { name: [...names].join(" "), x, y: top, width: right - x, height: bottom - top };
  });
  const isApart = frames.every((one, i) => frames.slice(i + 1).every((other) => !meet(one, other)));
  return frames.length > 1 && isApart ? frames : [];
}

// A box with the elements that it shows inside.
export function withParts(node: SceneNode, { dots, badges }: Contraction): SceneNode {
  return node.type !== "box"
    ? node
    : {
        ...node,
        data: { ...node.data, dots: dots.get(node.id) ?? [], badges: badges.get(node.id) ?? [] },
      };
}

// The wires with what they alone have. A coupling of several wires is revealed by the first.
export function contractedWires(wires: Wire[], { edges }: Contraction): Wire[] {
  const links = new Map(edges.map((edge) => [edge.id, edge]));
  const revealed = new Set<string>();
  return wires.map((wire) => {
    const link = links.get(wire.id);
    if (wire.data === undefined || link === undefined) {
      return wire;
    }
    const own = link.couplings.filter((id) => !revealed.has(id));
    own.forEach((id) => revealed.add(id));
    const chains = link.isChain ? wire.data.chains : [];
    const room = link.couplings.length > 0 ? CHIP : 0;
    return { ...wire, data: { ...wire.data, chains, room, content: link.content, revealed: own } };
  });
}

// The boxes that each box, part and wire is joined with.
export function linksOf(wires: Wire[], { boxes, dots, badges }: Contraction): Map<string, Set<string>> {
  const links = new Map(boxes.map((id) => [id, new Set<string>()]));
  const join = (id: string, ...others: string[]) => {
    links.set(id, new Set([...(links.get(id) ?? []), ...others]));
  };
  for (const { id, source, target, data } of wires) {
    join(source, target);
    join(target, source);
    [id, ...(data?.pills ?? [])].forEach((part) => join(part, source, target));
  }
  for (const [box, parts] of [...dots, ...badges]) {
    parts.forEach((part) => join(part, box));
  }
  return links;
}
