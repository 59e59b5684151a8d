// How charts look on the page and on paper: colours and sizes for uPlot, which draws onto canvases and reads
// no style sheets.

import type uPlot from "uplot";
import { type Shade, shade } from "./colors";
import { tick } from "./range";

export type Look = {
  shade: Shade;
  text: string;
  dim: string;
  grid: string;
  ground: string;
  // All lengths are multiples of this: 1 on the page.
  unit: number;
};

const FONT = 'system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", Arial, sans-serif';

export function pageLook(): Look {
  const style = getComputedStyle(document.documentElement);
  const variable = (name: string) => style.getPropertyValue(name).trim();
  return {
    shade: shade(),
    text: variable("--text"),
    dim: variable("--text-dim"),
    grid: variable("--grid"),
    ground: variable("--surface-raised"),
    unit: 1,
  };
}

export function paperLook(unit: number): Look {
  return { shade: "light", text: "#111111", dim: "#444444", grid: "#e6e6e6", ground: "#ffffff", unit };
}

export function font(look: Look, size = 11): string {
  return `${size * look.unit}px ${FONT}`;
}

export type AxisHow = { scale: string; side: 1 | 2 | 3; label?: string; grid?: boolean };

const LETTER = 6.4;

export function axis(look: Look, { scale, side, label, grid = true }: AxisHow): uPlot.Axis {
  const { unit } = look;
  const across = side === 2;
  return {
    scale,
    side,
    stroke: look.dim,
    font: font(look),
    labelFont: font(look),
    gap: 4 * unit,
    space: (across ? 56 : 26) * unit,
    size: across ? 20 * unit : (_, values) => (12 + LETTER * longest(values ?? [])) * unit,
    ...(label === undefined ? {} : { label, labelSize: 16 * unit, labelGap: 0 }),
    values: (_, splits, __, ___, step) => splits.map((value) => tick(value, step)),
    grid: { show: grid, stroke: look.grid, width: unit },
    ticks: { stroke: look.dim, width: unit, size: 4 * unit },
    border: { show: true, stroke: look.dim, width: unit },
  };
}

function longest(values: string[]): number {
  return values.reduce((most, value) => Math.max(most, value?.length ?? 0), 3);
}

// What all charts have in common.
export function frame(look: Look): Pick<uPlot.Options, "legend" | "cursor" | "padding"> {
  return {
    legend: { show: false },
    cursor: { drag: { x: false, y: false }, y: false, points: { size: 5 * look.unit } },
    padding: [8 * look.unit, 18 * look.unit, 0, 4 * look.unit],
  };
}
