// Boxes side by side: alignment at an edge or a middle, and equal gaps.

import { boundsOf, type Rect } from "../model/rects";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { isEditable } from "../state/editable";
import { getStage } from "./stage";

export type Boxes = Map<string, Rect>;

export type Alignment = { does: string; least: number; moved: (boxes: Boxes) => Boxes };

// At the share 0, 0.5 or 1 of the place that all boxes take together.
const edges = (does: string, place: "x" | "y", share: number): Alignment => ({
  does,
  least: 2,
  moved: (all) => {
    const bounds = boundsOf([...all.values()]);
    const size = place === "x" ? "width" : "height";
    const at = (box: Rect) => bounds[place] + share * (bounds[size] - box[size]);
    return new Map([...all].map(([id, box]) => [id, { ...box, [place]: at(box) }]));
  },
});

export const ALIGNMENTS: readonly Alignment[] = [
  edges("Align left edges", "x", 0),
  edges("Align right edges", "x", 1),
  edges("Align top edges", "y", 0),
  edges("Align bottom edges", "y", 1),
  edges("Align in a column, by their middles", "x", 0.5),
  edges("Align in a row, by their middles", "y", 0.5),
  { does: "Distribute horizontally", least: 3, moved: (all) => spread(all, "x", "width") },
  { does: "Distribute vertically", least: 3, moved: (all) => spread(all, "y", "height") },
];

// Align the selected boxes, as one step of undo.
export async function align({ moved, least: enough }: Alignment): Promise<void> {
  const boxes = selectedBoxes();
  if (!isEditable() || boxes.size < enough) {
    useStudio.getState().notify({ what: `Select at least ${enough} boxes first.` }, "info");
    return;
  }
  // of all boxes, as a drag does: others are arranged again around those that have a place
  const all = [...placedBoxes(), ...moved(boxes)];
  const positions = all.map(([id, { x, y }]) => [id, [Math.round(x), Math.round(y)]]);
  await request({ type: "place", positions: Object.fromEntries(positions) });
}

function selectedBoxes(): Boxes {
  const selected = new Set(useStudio.getState().selected);
  return new Map([...placedBoxes()].filter(([id]) => selected.has(id)));
}

function placedBoxes(): Boxes {
  const scene = getStage()?.scene();
  const boxes: Boxes = new Map();
  for (const { id, type, width = 0, height = 0 } of scene?.nodes ?? []) {
    const at = scene?.places.elements.get(id);
    if (type === "box" && at !== undefined) {
      boxes.set(id, { ...at, width, height });
    }
  }
  return boxes;
}

// The outer boxes stay; the gaps between all become equal.
function spread(all: Boxes, place: "x" | "y", size: "width" | "height"): Boxes {
  const order = [...all].sort(([, a], [, b]) => a[place] - b[place]);
  const first = order[0]?.[1];
  const last = order.at(-1)?.[1];
  if (first === undefined || last === undefined) {
    return all;
  }
  const filled = order.reduce((sum, [, box]) => sum + box[size], 0);
  const gap = (last[place] + last[size] - first[place] - filled) / (order.length - 1);
  let next = first[place];
  return new Map(
    order.map(([id, box]) => {
      const moved = { ...box, [place]: next };
      next += box[size] + gap;
      return [id, moved];
    }),
  );
}
