// Slices of an array over three axes, one at right angles to each axis: at the position of its slider, or at
// the back of the box the maximum over the axis. With more axes a section at positions on the others.

import { useMemo, useRef } from "react";
import type { AxisView } from "../../protocol";
import { useStudio } from "../../store";
import type { Live, Wish } from "../../streams";
import { axisHeader, plane, type Table } from "../../draw/table";
import { axisLabel, edges, points } from "../../draw/axis";
import { isPicture, portAxes } from "../../model/ports";
import { onBoth, shade } from "../colors/colors";
import { FollowingColors, middleOf, scaleOf } from "../colors/mapColors";
import { paintHeat } from "../../draw/paint";
import { extent } from "../../draw/scale";
import type { PlotProps } from "../PlotFrame";
import type { MapColors } from "../../draw/content";
import { readContent } from "../../draw/cursorText";
import { reading } from "../../draw/text";
import { planeContent } from "../kinds/parts";
import { ScenePlot } from "./ScenePlot";
import type { SceneFrame } from "./sceneFrame";
import { volumeSize } from "./sceneSize";
import { cameraAt, type Viewpoint } from "./sceneView";
import type { SceneStage } from "./sceneStage";
import { useLevels } from "../useLevels";
import { usePorts } from "../usePorts";
import { type ScenePosition, useScene } from "./useScene";
import { useStreams } from "../useStreams";

const MOST = 128;
const CUTS = [0, 1, 2] as const;
const NO_COLORS: MapColors = { range: [0, 1], middle: null, tables: onBoth(new Uint8ClampedArray()) };

export function Volume(props: PlotProps) {
  const { element, port, settings, visible, set } = props;
  const { at } = settings;
  const kind = useStudio((state) => state.kinds.get(element.kind));
  const ports = usePorts(element, port, (axes) => axes.length > 2 && !isPicture(axes));
  const scale = scaleOf(settings.scale, kind, port);
  const stored = useStudio(({ document }) =>
    JSON.stringify((document && portAxes(document, element, port)) || []),
  );
  const axes = useMemo(
    () => inOrder(JSON.parse(stored) as AxisView[], settings.drawn),
    [stored, settings.drawn],
  );
  const drawn = axes.slice(0, 3);
  const canvases = useMemo(() => CUTS.map(() => document.createElement("canvas")), []);
  const newest = useRef<Live[]>([]);
  const colors = useRef(new FollowingColors());
  const levels = useLevels(element.id, port, () => redraw());
  // Each slice has the other two axes.
  const wishes = useMemo<Wish[]>(
    () =>
      CUTS.map((cut) => {
        const shown = axes.slice(0, 3).flatMap((axis, d) => (d === cut ? [] : [axis.name]));
        const others = Object.fromEntries(Object.entries(at).filter(([axis]) => !shown.includes(axis)));
        return { type: "watch", element: element.id, port, most: MOST, drawn: shown, at: others };
      }),
    [element.id, port, axes, at],
  );

  const place = (axis: AxisView) => {
    const position = at[axis.name];
    const [lower, upper] = edges(axis);
    return position === undefined ? null : Math.min(1, Math.max(0, (position - lower) / (upper - lower)));
  };
  const show = (stage: SceneStage, view: Viewpoint): SceneFrame | null => {
    const [x, y, z] = drawn;
    const frames = newest.current.map(({ frame }) => frame?.values);
    if (
      x === undefined ||
      y === undefined ||
      z === undefined ||
      frames.length < 3 ||
      frames.includes(undefined)
    ) {
      return null;
    }
    const ends = frames.flatMap((values) => [...(extent(values ?? []) ?? [])]);
    colors.current.follow(ends, scale, middleOf(scale.twoSided, levels.current), settings.range);
    const { range, tables } = colors.current.now;
    const camera = cameraAt(view);
    const size = volumeSize(x, y, z);
    const slices = CUTS.map((axis) => {
      const canvas = canvases[axis] as HTMLCanvasElement;
      const [nx = 0, ny = 0] = newest.current[axis]?.form?.shape ?? [];
      paintHeat(canvas, frames[axis] as Float32Array, nx, ny, range, tables[shade()]);
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
    return { size, axes: [named(x), named(y), named(z)], bar: colors.current.now };
  };
  const streaming = useStreams(wishes, visible, (lives) => {
    newest.current = lives;
    redraw();
  });
  const scene = useScene({
    label: `Slices of ${port} of ${element.path} over ${drawn.map((axis) => axis.name).join(", ")}`,
    view: settings.view,
    keep: (view) => set({ view }),
    read: (positions, slice) => readSlices(drawn, newest.current, positions, slice),
    show,
  });
  const { redraw } = scene;

  return (
    <ScenePlot
      {...props}
      kind="volume"
      ports={ports}
      streaming={streaming}
      scene={scene}
      colors={colors}
      axes={axes}
      labels={["First axis", "Second axis", "Upwards"]}
      cut={axes}
      label={`Slices of ${element.path}; the arrow keys turn them`}
      table={() => tableOf(drawn, newest.current, at, port)}
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
  const plane = planeContent(null, lives[cut], "", () => NO_COLORS);
  if (plane === null) {
    return "";
  }
  const [across = null, up = null] = at.filter((_, d) => d !== cut);
  const [axis, position] = [axes[cut], at[cut] ?? null];
  const word = axis === undefined || position === null ? "" : `${axis.name} ${reading(position)}   `;
  return word + readContent(plane, { x: across, y: up });
}
