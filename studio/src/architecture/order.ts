// The elements in the order of the canvas: frame by frame of the grid, and in a frame row by row; else group
// by group of the document.

import type { ElementView, Kind } from "../protocol";
import { boxSize } from "./boxes";
import { contract } from "./contract";
import { inGrid } from "./contracted";
import { digitOf, partsOf } from "./grid";
import type { Point } from "../model/rects";
import { type Branch, tree } from "./tree";
import type { Structure } from "./contract";

export type OrderedFrame = Readonly<{ title: string; elements: readonly ElementView[] }>;

export function canvasOrder(structure: Structure, kinds: Map<string, Kind>): OrderedFrame[] {
  const contraction = contract(structure, kinds);
  const names = new Map(structure.elements.map((e) => [e.id, e]));
  if (contraction === null) {
    return byGroup(tree(structure.elements, structure.groups, [], new Set()).root, names);
  }
  const sizes = new Map(structure.elements.map((e) => [e.id, boxSize(e)]));
  const stored = new Map(Object.entries(structure.layout.boxes));
  const grid = inGrid({ contraction, names, kinds, sizes }, stored);
  const places = grid.size === 0 ? grid : new Map([...grid, ...stored]);
  const others = structure.elements.filter(({ id }) => !places.has(id));
  return [...byFrame(structure.elements, places), { title: "", elements: others }];
}

function byGroup(branch: Branch, names: Map<string, ElementView>): OrderedFrame[] {
  const elements = branch.elements.flatMap((id) => names.get(id) ?? []);
  return [{ title: branch.key, elements }, ...branch.groups.flatMap((group) => byGroup(group, names))];
}

function byFrame(elements: ElementView[], places: Map<string, Point>): OrderedFrame[] {
  const at = ({ id }: ElementView): Point => places.get(id) ?? { x: 0, y: 0 };
  const suffixOf = ({ name }: ElementView): string => partsOf(name).suffix;
  const frameOf = (element: ElementView): string => digitOf(suffixOf(element));
  const fromLeft = elements.filter(({ id }) => places.has(id)).sort((a, b) => at(a).x - at(b).x);
  return [...new Set(fromLeft.map(frameOf))].map((frame) => {
    const members = fromLeft.filter((element) => frameOf(element) === frame);
    return {
      title: [...new Set(members.map(suffixOf))].join(" ").trim(),
      elements: members.sort((a, b) => at(a).y - at(b).y || at(a).x - at(b).x),
    };
  });
}
