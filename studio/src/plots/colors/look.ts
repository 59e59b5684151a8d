// How charts look on the page and on paper: colours and sizes for uPlot, which draws onto canvases and reads
// no style sheets.

import type uPlot from "uplot";
import { type Shade, shade } from "./colors";
import { tick } from "../range";
import { TYPEFACE } from "../../typeface";

// The room that a colour bar needs, as a padding of the chart.
const BAR_ROOM = 66;

export type Look = {
  shade: Shade;
  text: string;
  dim: string;
  grid: string;
  ground: string;
  // All lengths are multiples of this: 1 on the page.
  unit: number;
  // Whether the plot is so small that it shows numbers at its axes only.
  small: boolean;
};

// Below these sizes, in pixels of the page, names of axes and colour bars would leave no room for the values.
const SMALL = { width: 240, height: 130 };

export function isSmall(width: number, height: number): boolean {
  return width < SMALL.width || height < SMALL.height;
}

export function pageLook(small = false): Look {
  const style = getComputedStyle(document.documentElement);
  const variable = (name: string) => style.getPropertyValue(name).trim();
  return {
    shade: shade(),
    text: variable("--text"),
    dim: variable("--text-dim"),
    grid: variable("--grid"),
    ground: variable("--surface-raised"),
    unit: 1,
    small,
  };
}

export function paperLook(unit: number, small = false): Look {
  const colors = { text: "#111111", dim: "#444444", grid: "#e6e6e6", ground: "#ffffff" };
  return { shade: "light", ...colors, unit, small };
}

export function font(look: Look, size = 11): string {
  return `${size * look.unit}px ${TYPEFACE}`;
}

export type AxisHow = { scale: string; side: 1 | 2 | 3; label?: string; grid?: boolean };

const LETTER = 6.4;
const SMALL_LETTER = 5.8;
// About the distance of two numbers of a small plot.
const SIDE = 40;

export function axis(look: Look, { scale, side, label, grid = true }: AxisHow): uPlot.Axis {
  const { unit, small } = look;
  const across = side === 2;
  const size = small ? 10 : 11;
  const [letter, edge, low] = small ? [SMALL_LETTER, 7, 15] : [LETTER, 12, 20];
  return {
    scale,
    side,
    stroke: look.dim,
    font: font(look, size),
    labelFont: font(look, size),
    gap: (small ? 2 : 4) * unit,
    space: small
      ? (_, __, low, high, room) => (across ? widest(low, high, room / unit) : 20) * unit
      : (across ? 56 : 26) * unit,
    size: across ? low * unit : (_, values) => (edge + letter * longest(values ?? [], small ? 2 : 3)) * unit,
    ...(label === undefined || small ? {} : { label, labelSize: 16 * unit, labelGap: 0 }),
    values: (_, splits, __, ___, step) => splits.map((value) => tick(value, step)),
    grid: { show: grid, stroke: look.grid, width: unit },
    ticks: { stroke: look.dim, width: unit, size: (small ? 3 : 4) * unit },
    border: { show: true, stroke: look.dim, width: unit },
  };
}

// The distance of numbers side by side, from the longest one within a range of values.
function widest(low: number, high: number, room: number): number {
  const digits = Math.max(0, -Math.floor(Math.log10(((high - low) * SIDE) / room)));
  const length = Math.max(...[low, high].map((value) => value.toFixed(Math.min(6, digits)).length));
  return SMALL_LETTER * length + 8;
}

function longest(values: string[], least: number): number {
  return values.reduce((most, value) => Math.max(most, value?.length ?? 0), least);
}

// What all charts have in common.
export function frame(look: Look): Pick<uPlot.Options, "legend" | "cursor" | "padding"> {
  return {
    legend: { show: false },
    cursor: { drag: { x: false, y: false }, y: false, points: { size: 5 * look.unit } },
    padding: look.small
      ? [6 * look.unit, 12 * look.unit, 0, 2 * look.unit]
      : [8 * look.unit, 18 * look.unit, 0, 4 * look.unit],
  };
}

// What all charts have in common whose values are colours: room for a colour bar, a cursor on both axes, and
// a series that draws nothing.
export function mapFrame(look: Look): Pick<uPlot.Options, "legend" | "cursor" | "padding" | "series"> {
  const base = frame(look);
  return {
    ...base,
    cursor: { ...base.cursor, y: true, points: { show: false } },
    ...(look.small ? {} : { padding: [10 * look.unit, BAR_ROOM * look.unit, 0, 4 * look.unit] }),
    series: [{}, { scale: "y", paths: () => null, points: { show: false } }],
  };
}
