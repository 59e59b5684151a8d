// Slices of an array over three axes, one at right angles to each axis: at the position of its slider, or at
// the back of the box the maximum over the axis. With more axes a section at positions on the others.

import { useMemo } from "react";
import { axisLabel, edges, points } from "../../draw/axis";
import { readContent } from "../../draw/cursorText";
import { paintHeat } from "../../draw/paint";
import { extent } from "../../draw/scale";
import { axisHeader, plane, type Table } from "../../draw/table";
import { reading } from "../../draw/text";
import { portAxes } from "../../model/ports";
import type { AxisView } from "../../protocol";
import { useSame } from "../../state/useSame";
import type { Live, Wish } from "../../server/streams";
import { shade } from "../../model/colors";
import type { PlotProps } from "../PlotFrame";
import type { SceneFrame } from "../export/sceneFrame";
import { planeOf, ScenePlot, type ShownScene } from "./ScenePlot";
import { volumeSize } from "./sceneSize";
import { cameraAt } from "../../model/sceneView";
import type { ScenePosition } from "./useScene";

const MOST = 128;
const CUTS = [0, 1, 2] as const;

export function Volume(props: PlotProps) {
  const { element, port, settings } = props;
  const { at } = settings;
  const stored = useSame(({ document }) => (document && portAxes(document, element, port)) || []);
  const axes = useMemo(() => inOrder(stored, settings.drawn), [stored, settings.drawn]);
  const drawn = axes.slice(0, 3);
  const canvases = useMemo(() => CUTS.map(() => globalThis.document.createElement("canvas")), []);
  // Each slice has the other two axes.
  const wishes = CUTS.map((cut): Wish => {
    const shown = drawn.flatMap((axis, d) => (d === cut ? [] : [axis.name]));
    const others = Object.fromEntries(Object.entries(at).filter(([axis]) => !shown.includes(axis)));
    return { type: "watch", element: element.id, port, most: MOST, drawn: shown, at: others };
  });
  const place = (axis: AxisView) => {
    const position = at[axis.name];
    const [lower, upper] = edges(axis);
    return position === undefined ? null : Math.min(1, Math.max(0, (position - lower) / (upper - lower)));
  };
  const show = (lives: Live[], { stage, view, colors }: ShownScene): SceneFrame | null => {
    const [x, y, z] = drawn;
    const frames = lives.flatMap(({ frame }) => frame?.values ?? []);
    if (x === undefined || y === undefined || z === undefined || frames.length < 3) {
      return null;
    }
    const bar = colors(frames.flatMap((values) => [...(extent(values) ?? [])]));
    const camera = cameraAt(view);
    const size = volumeSize(x, y, z);
    const slices = CUTS.map((axis) => {
      const canvas = canvases[axis] as HTMLCanvasElement;
      const [nx = 0, ny = 0] = lives[axis]?.form?.shape ?? [];
      paintHeat(canvas, frames[axis] as Float32Array, nx, ny, bar.range, bar.tables[shade()]);
      const behind = camera[axis] < 0 ? 1 : 0;
      return { axis, canvas, place: place(drawn[axis] as AxisView) ?? behind };
    });
    stage.showSlices(slices, size);
    const named = (axis: AxisView) => ({
      label: axisLabel(axis),
      range: edges(axis),
      along: axis,
      folded: place(axis) === null,
    });
    return { size, axes: [named(x), named(y), named(z)], bar };
  };
  return (
    <ScenePlot
      {...props}
      kind="volume"
      least={3}
      wishes={wishes}
      show={show}
      read={(lives, positions, slice) => readSlices(drawn, lives, positions, slice)}
      table={(lives) => tableOf(drawn, lives, at, port)}
      axes={() => axes}
      labels={["First axis", "Second axis", "Upwards"]}
      cut={() => axes}
      label={(names) => `Slices of ${port} of ${element.path} over ${names.join(", ")}`}
      turning={`Slices of ${element.path}; the arrow keys turn them`}
    />
  );
}

// The axes with names that differ, as the server sends them; those that are chosen come first.
function inOrder(axes: AxisView[], chosen: string[]): AxisView[] {
  const names = axes.map(({ name }) => name);
  const numbered = axes.map((axis, d) => {
    const count = names.slice(0, d + 1).filter((name) => name === axis.name).length;
    return count === 1 ? axis : { ...axis, name: `${axis.name} ${count}` };
  });
  const first = chosen.flatMap((name) => numbered.filter((axis) => axis.name === name));
  return [...first, ...numbered.filter((axis) => !first.includes(axis))];
}

// One row for each value of each slice; a maximum has no position on its axis.
function tableOf(axes: AxisView[], lives: Live[], at: Record<string, number>, port: string): Table | null {
  const columns: (number | null)[][] = axes.map(() => []);
  const values: number[] = [];
  for (const cut of CUTS) {
    const { form, frame } = lives[cut] ?? {};
    const [one, other] = form?.axes ?? [];
    if (form == null || frame == null || one === undefined || other === undefined) {
      return null;
    }
    const [across, up] = plane(points(one, form.shape[0]), points(other, form.shape[1]), []);
    const position = at[axes[cut]?.name ?? ""] ?? null;
    const rest = [across, up];
    axes.forEach((_, d) => {
      const column = d === cut ? null : rest.shift();
      for (let i = 0; i < frame.values.length; i++) {
        columns[d]?.push(column == null ? position : (column[i] ?? null));
      }
    });
    values.push(...frame.values);
  }
  const shown = lives.flatMap(({ form }) =>
    (form?.axes ?? []).map((axis, d) => [axis.name, form?.shape[d]] as const),
  );
  const header = axes.map((axis) => axisHeader(axis, shown.find(([name]) => name === axis.name)?.[1]));
  return { header: [...header, port], columns: [...columns, values] };
}

// What lies at positions: on the slice with the pointer, else on the one with the most of the positions.
function readSlices(axes: AxisView[], lives: Live[], at: ScenePosition, slice: number | null): string {
  const known = (cut: number) => at.filter((value, d) => d !== cut && value !== null).length;
  const cut = slice ?? CUTS.reduce<number>((best, other) => (known(other) > known(best) ? other : best), 0);
  const plane = planeOf(lives[cut], "");
  if (plane === null) {
    return "";
  }
  const [across = null, up = null] = at.filter((_, d) => d !== cut);
  const [axis, position] = [axes[cut], at[cut] ?? null];
  const word = axis === undefined || position === null ? "" : `${axis.name} ${reading(position)}   `;
  return word + readContent(plane, { x: across, y: up });
}
