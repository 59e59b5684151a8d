// What several kinds of plots have in common.

import { type Axis, commonScale, edges } from "../../draw/axis";
import type { Content, LevelLine, CurveLine, MapColors, PlotMark, PlotSide } from "../../draw/content";
import type { Paint, Shade } from "../../draw/ink";
import { extent, type Range, union } from "../../draw/scale";
import { firstAt } from "../../draw/series";
import { portAxes, runsDown } from "../../model/ports";
import type { AxisView, DocumentView } from "../../protocol";
import type { Live } from "../../server/streams";
import { curveColor, FIELD_COLORS, portColor } from "../../model/colors";
import { type Level, levelsOf, thresholdOf } from "../../model/levels";
import { timeRange } from "../../model/traces";
import type { Shown } from "./kind";

const paint = (color: (shade: Shade) => string): Paint => ({ light: color("light"), dark: color("dark") });

export const curvePaint = (n: number): Paint => paint((shade) => curveColor(n, shade));
export const portPaint = (port: string, ports: string[]): Paint =>
  paint((shade) => portColor(port, ports, shade));
export const LEVEL: Paint = paint((shade) => FIELD_COLORS[shade].level);

export function levelsAt({ document, element, type }: Shown, port: string): Level[] {
  return levelsOf(document, element, type, port);
}

export function levelMarks(levels: readonly Level[]): LevelLine[] {
  return levels.map(({ label, value }) => ({ type: "level", label, value, color: LEVEL }));
}

// How activation is drawn above its threshold; of other values nothing is changed there.
export function aboveThreshold(port: string, levels: readonly Level[]): Pick<CurveLine, "above"> {
  const value = thresholdOf(levels);
  return port === "activation" && value !== null
    ? { above: { value, color: paint((shade) => FIELD_COLORS[shade].ember) } }
    : {};
}

export function line(label: string, color: Paint, xs: ArrayLike<number>, ys: ArrayLike<number>): CurveLine {
  return { type: "line", label, color, width: 1.5, xs, ys };
}

// The axes at a port: those that the plot draws first.
export function axesOf({ document, element, port, settings }: Shown, ports = [port]): AxisView[] {
  const all = ports.flatMap((other) => portAxes(document, element, other) ?? []);
  const first = settings.drawn.flatMap((name) => all.find((axis) => axis.name === name) ?? []);
  return [...first, ...all.filter((axis) => !first.includes(axis))];
}

// Time at the lower side, or at the upright one.
export function timeSide({ document, settings }: Shown, range: Range): PlotSide {
  const down = settings.down ? { down: true } : {};
  return { along: "time", unit: document.time_unit, range, ...down };
}

// The times that are shown, of samples between two times.
export function spanOf({ document, settings: { window }, moment }: Shown, ends: Range | null): Range {
  if (ends === null) {
    return [0, window ?? 1];
  }
  const [first, last] = ends;
  // a record shorter than the window has no more to come
  const all = document.record != null && window !== null && last - first < window;
  return timeRange(first, last, all ? null : window, moment);
}

// The first and the last of times in order, of several courses.
export function endsOf(courses: readonly (readonly number[])[]): Range | null {
  return courses.reduce<Range | null>((ends, times) => {
    const [first, last] = [times[0], times[times.length - 1]];
    const own = first === undefined || last === undefined ? null : ([first, last] as const);
    return ends === null || own === null ? (ends ?? own) : union(ends, own);
  }, null);
}

// The courses that are seen within times, as lines.
export function courseLines(
  lives: readonly Live[],
  [from]: Range,
  how: (i: number) => [string, Paint],
): CurveLine[] {
  return lives.map(({ history: { times, values } }, i) => {
    const start = firstAt(times, from);
    return line(...how(i), times.slice(start), values.slice(start));
  });
}

export function extentOf(lines: readonly CurveLine[]): Range | null {
  return lines.reduce<Range | null>((all, { ys }) => {
    const own = extent(ys as ArrayLike<number>);
    return all === null || own === null ? (all ?? own) : union(all, own);
  }, null);
}

export function momentMarks({ moment }: Shown): PlotMark[] {
  return moment === null ? [] : [{ type: "moment", time: moment }];
}

type Plane = { x: AxisView; y: AxisView; map: { values: Float32Array; nx: number; ny: number } };

// The newest values over the first two axes, and how many they are along each; null: some are not known yet.
export function planeIn(live: Live | undefined): Plane | null {
  const [[x, y], [nx, ny]] = [live?.form?.axes ?? [], live?.form?.shape ?? []];
  const values = live?.frame?.values;
  return x === undefined || y === undefined || nx === undefined || ny === undefined || values === undefined
    ? null
    : { x, y, map: { values, nx, ny } };
}

// An array over two axes as colours, upright as in the document.
export function planeContent(
  document: DocumentView | null,
  live: Live | undefined,
  label: string,
  colors: (values: Float32Array) => MapColors,
): Content | null {
  const plane = planeIn(live);
  if (plane === null) {
    return null;
  }
  const { x, y, map } = plane;
  return {
    x: { along: x, range: edges(x) },
    y: { along: y, range: edges(y), down: document !== null && runsDown(document, y) },
    equal: commonScale(x, y) !== null,
    marks: [{ type: "map", label, ...map, colors: colors(map.values) }],
  };
}

export function over(axes: readonly Axis[], many: number): string {
  return axes
    .slice(0, many)
    .map(({ name }) => name)
    .join(" and ");
}

// The path of an element beside a trace of another plot; empty for the plot's own.
export function pathOf({ element, elements }: Shown, id: string): string {
  return id === element.id ? "" : (elements.get(id)?.path ?? "gone");
}
