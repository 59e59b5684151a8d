// The groups that are folded: those that the document stores, or, in a document without a layout of its own,
// those that were folded when it was opened, so that names can be read.

import { create } from "zustand";
import { BOX, LIVE } from "./boxes";
import { chains } from "./chains";
import { MARGIN } from "./fit";
import { PANEL } from "./layout";
import type { Point, Size } from "../model/rects";
import { scene } from "./scene";
import type { Structure } from "./contract";
import type { Kind } from "../protocol";
import { useStudio } from "../server/store";
import { tree, type Branch } from "./tree";

// The zoom factor at which about eleven letters of a name fit into a box.
const READABLE = 0.42;
// Fewer folded groups are better than a gain smaller than this.
const GAIN = 1.2;

// `panel` is the size of the canvas for which they were chosen.
export type Opening = { folded: string[]; panel: Size };

export const useOpening = create<Opening>(() => ({ folded: [], panel: PANEL }));

export function foldedNow(): string[] {
  return useStudio.getState().document?.layout.folded ?? useOpening.getState().folded;
}

// The structure with the groups that are folded in it.
export function withFolded(structure: Structure, folded: string[]): Structure {
  const { layout } = structure;
  return layout.folded !== null ? structure : { ...structure, layout: { ...layout, folded } };
}

// Groups fold from inside out, one depth after another, until names are readable on a canvas of this size.
export function firstFolded(structure: Structure, kinds: Map<string, Kind>, panel: Size): string[] {
  const { folded: stored, boxes } = structure.layout;
  if (stored !== null || Object.keys(boxes).length > 0) {
    return stored ?? [];
  }
  const depths = byDepth(tree(structure.elements, structure.groups, [], new Set()).root, 0, []);
  let best: { folded: string[]; zoom: number } | null = null;
  for (let depth = depths.length; depth >= 0; depth--) {
    const folded = depths.slice(depth).flat();
    const zoom = zoomWith(structure, kinds, panel, folded);
    if (zoom >= READABLE) {
      return folded;
    }
    if (best === null || zoom > best.zoom * GAIN) {
      best = { folded, zoom };
    }
  }
  return best?.folded ?? [];
}

// The zoom factor at which everything fits on a canvas; where the boxes cannot be readable, without a
// layout, the one at which they would cover it.
function zoomWith(structure: Structure, kinds: Map<string, Kind>, panel: Size, folded: string[]): number {
  const shown = withFolded(structure, folded);
  const { root } = tree(shown.elements, shown.groups, folded, chains(shown, kinds).couplings);
  const covered = Math.sqrt(
    (panel.width * panel.height) / (visible(root) * BOX.width * (BOX.title + LIVE.number)),
  );
  if (covered < READABLE) {
    return covered;
  }
  const { whole } = scene(shown, kinds, panel).places;
  const { left, right, top, bottom } = MARGIN;
  return Math.min((panel.width - left - right) / whole.width, (panel.height - top - bottom) / whole.height);
}

// The number of boxes and folded groups.
function visible(branch: Branch): number {
  return branch.groups.reduce(
    (sum, group) => sum + (group.folded ? 1 : visible(group)),
    branch.elements.length,
  );
}

// New positions of all elements, for the canvas and the folded groups of now.
export function tidied(structure: Structure, kinds: Map<string, Kind>): Map<string, Point> {
  const { folded, panel } = useOpening.getState();
  const free = { ...structure, layout: { ...structure.layout, boxes: {} } };
  return scene(withFolded(free, folded), kinds, panel).places.elements;
}

function byDepth(branch: Branch, depth: number, found: string[][]): string[][] {
  for (const group of branch.groups) {
    found[depth] = [...(found[depth] ?? []), group.key];
    byDepth(group, depth + 1, found);
  }
  return found;
}
