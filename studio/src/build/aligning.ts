// Boxes side by side: alignment at an edge or a middle, and equal gaps.

import type { Rect } from "../graph/layout/rects";
import { request } from "../socket";
import { useStudio } from "../store";
import { isEditable } from "./editable";
import { getStage } from "./stage";

export type Boxes = Map<string, Rect>;

export type Alignment = { does: string; least: number; moved: (boxes: Boxes) => Boxes };

const right = ({ x, width }: Rect) => x + width;
const bottom = ({ y, height }: Rect) => y + height;

export const ALIGNMENTS: readonly Alignment[] = [
  { does: "Align left edges", least: 2, moved: (all) => each(all, () => ({ x: least(all, ({ x }) => x) })) },
  {
    does: "Align right edges",
    least: 2,
    moved: (all) => each(all, ({ width }) => ({ x: most(all, right) - width })),
  },
  { does: "Align top edges", least: 2, moved: (all) => each(all, () => ({ y: least(all, ({ y }) => y) })) },
  {
    does: "Align bottom edges",
    least: 2,
    moved: (all) => each(all, ({ height }) => ({ y: most(all, bottom) - height })),
  },
  {
    does: "Align in a column, by their middles",
    least: 2,
    moved: (all) => {
      const middle = (least(all, ({ x }) => x) + most(all, right)) / 2;
      return each(all, ({ width }) => ({ x: middle - width / 2 }));
    },
  },
  {
    does: "Align in a row, by their middles",
    least: 2,
    moved: (all) => {
      const middle = (least(all, ({ y }) => y) + most(all, bottom)) / 2;
      return each(all, ({ height }) => ({ y: middle - height / 2 }));
    },
  },
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

const least = (all: Boxes, of: (box: Rect) => number) => Math.min(...[...all.values()].map(of));
const most = (all: Boxes, of: (box: Rect) => number) => Math.max(...[...all.values()].map(of));

function each(all: Boxes, change: (box: Rect) => Partial<Rect>): Boxes {
  return new Map([...all].map(([id, box]) => [id, { ...box, ...change(box) }]));
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
