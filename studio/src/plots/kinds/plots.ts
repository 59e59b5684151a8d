// The plots of the page: each file `NAME.plot.ts` of this folder declares one.

import type { AxisView, PlotView } from "../../protocol";
import { fits, type PlotKind } from "../../model/ports";
import type { Further, PlotDeclaration } from "./kind";

const FILES = import.meta.glob<PlotDeclaration>("./*.plot.ts", { eager: true, import: "plot" });

export const PLOTS: ReadonlyMap<PlotKind, PlotDeclaration> = new Map(
  Object.entries(FILES).map(([file, plot]) => [file.slice("./".length, -".plot.ts".length), plot]),
);

// The kinds of plot for an array over these axes; the best one first, those of packages last.
export function plotKinds(
  axes: AxisView[] | null,
  packaged: PlotView[] = [],
  further: Further = {},
): PlotKind[] {
  const ranked = [...PLOTS].flatMap(([name, plot]) => {
    const rank = plot.rank(axes ?? [], further);
    return rank === null ? [] : [{ name, rank }];
  });
  return [
    ...ranked.sort((a, b) => a.rank - b.rank).map(({ name }) => name),
    ...packaged
      .filter((plot) => axes !== null && axes.length > 0 && fits(plot, axes))
      .map((plot) => plot.name),
  ];
}

// Whether `deodar plot` has a figure that draws the same as a plot of an array over this number of axes:
// figures have no sections.
export function hasFigure(kind: PlotKind, axes: number): boolean {
  return axes <= (PLOTS.get(kind)?.figure ?? -1);
}

export function titleOf(kind: PlotKind, packaged: PlotView[]): string {
  return (PLOTS.get(kind) ?? packaged.find((plot) => plot.name === kind))?.title ?? kind;
}
