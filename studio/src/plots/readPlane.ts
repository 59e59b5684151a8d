// What lies at a cursor in an array over two axes, in words.

import type { AxisView } from "../protocol";
import type { Live } from "../streams";
import type { CursorAt } from "./chart/chartCursor";
import { cell } from "../model/axes";
import { reading } from "./range";

// Where the cursor of another plot has a position on one axis only, the maximum over the other axis.
export function readPlane(live: Live | null, x: AxisView, y: AxisView, at: CursorAt): string {
  const [nx = x.samples, ny = y.samples] = live?.form?.shape ?? [];
  const values = live?.frame?.values;
  const words = [
    ...(at.x === null ? [] : [`${x.name} ${reading(at.x)}`]),
    ...(at.y === null ? [] : [`${y.name} ${reading(at.y)}`]),
  ];
  if (values === undefined) {
    return "";
  }
  const columns = at.x === null ? range(nx) : [cell(x, nx, at.x)];
  const rows = at.y === null ? range(ny) : [cell(y, ny, at.y)];
  const most = columns.reduce(
    (high, i) => rows.reduce((most, j) => Math.max(most, values[i * ny + j] ?? -Infinity), high),
    -Infinity,
  );
  if (!Number.isFinite(most)) {
    return words.join("   ");
  }
  const folded = at.x === null || at.y === null ? "max " : "";
  return [...words, `${folded}${reading(most)}`].join("   ");
}

function range(count: number): number[] {
  return Array.from({ length: count }, (_, i) => i);
}
