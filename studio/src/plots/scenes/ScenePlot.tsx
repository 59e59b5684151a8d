// A plot in three dimensions: what those of all kinds have in common around what they show.

import { useMemo, useRef } from "react";
import type { Content, MapColors } from "../../draw/content";
import type { Table } from "../../draw/table";
import { isPicture } from "../../model/ports";
import type { Announced, AxisView } from "../../protocol";
import { useStudio } from "../../server/store";
import type { Live, Wish } from "../../server/streams";
import { onBoth } from "../../model/colors";
import { FollowingColors, middleOf, scaleOf } from "../../model/mapColors";
import { AxisControl, ColorControl, RangeControl } from "../controls/PlotSettingsControls";
import { SectionStrip } from "../controls/SectionStrip";
import { planeContent } from "../kinds/parts";
import { PlotFrame, type PlotProps } from "../PlotFrame";
import { useLevels } from "../../widgets/useLevels";
import { usePorts } from "../../widgets/usePorts";
import { useStreams } from "../useStreams";
import type { SceneFrame } from "../export/sceneFrame";
import type { SceneStage } from "./sceneStage";
import type { Viewpoint } from "../../model/sceneView";
import { type SceneContent, useScene } from "./useScene";

const NO_COLORS: MapColors = { range: [0, 1], middle: null, tables: onBoth(new Uint8ClampedArray()) };

// A stream over two axes as a plot from above, whose colours are not seen: for the cursor and the table.
export const planeOf = (live: Live | undefined, port: string): Content | null =>
  planeContent(null, live, port, () => NO_COLORS);

export type ShownScene = {
  stage: SceneStage;
  view: Viewpoint;
  colors: (values: ArrayLike<number>) => MapColors;
};

type ScenePlotProps = PlotProps & {
  kind: "surface" | "volume";
  // The fewest axes that a port needs.
  least: number;
  wishes: Wish[];
  // Puts values on the stage; null: some are missing.
  show: (lives: Live[], scene: ShownScene) => SceneFrame | null;
  read: (lives: Live[], ...at: Parameters<SceneContent["read"]>) => string;
  table: (lives: Live[]) => Table | null;
  // All axes, the drawn ones first, what these are called, and the axes with a slider.
  axes: (form: Announced | null) => AxisView[];
  labels: string[];
  cut: (form: Announced | null) => AxisView[];
  // What it shows over drawn axes, and how it is turned, in words.
  label: (drawn: string[]) => string;
  turning: string;
};

export function ScenePlot(props: ScenePlotProps) {
  const { element, port, settings, visible, set, labels } = props;
  const kind = useStudio((state) => state.kinds.get(element.kind));
  const ports = usePorts(element, port, (axes) => axes.length >= props.least && !isPicture(axes));
  const scale = scaleOf(settings.scale, kind, port);
  const newest = useRef<Live[]>([]);
  const following = useMemo(() => new FollowingColors(), []);
  const levels = useLevels(element.id, port, () => scene.redraw());
  const colors = (values: ArrayLike<number>) => {
    following.follow(values, scale, middleOf(scale.twoSided, levels.current), settings.range);
    return following.now;
  };
  const streaming = useStreams(props.wishes, visible, (lives) => {
    newest.current = lives;
    scene.redraw();
  });
  const form = streaming.forms[0] ?? null;
  const axes = props.axes(form);
  const scene = useScene({
    label: props.label(axes.slice(0, labels.length).map(({ name }) => name)),
    view: settings.view,
    keep: (view) => set({ view }),
    read: (...at) => props.read(newest.current, ...at),
    show: (stage, view) => props.show(newest.current, { stage, view, colors }),
  });
  const { host, problem, exportAs } = scene;
  return (
    <PlotFrame
      {...props}
      ports={ports}
      streaming={{ ...streaming, seen: streaming.seen && problem === null, lost: problem ?? streaming.lost }}
      strip={<SectionStrip rest={props.cut(form)} at={settings.at} set={set} />}
      controls={
        <>
          <AxisControl axes={axes} labels={labels} set={set} />
          <ColorControl settings={settings} set={set} />
          <RangeControl settings={settings} shown={() => following.now.range} set={set} />
        </>
      }
      table={() => props.table(newest.current)}
      exportAs={(format) => exportAs(`${element.path} ${port}`, format)}
    >
      <div
        ref={host}
        className="plot-host plot-turning"
        tabIndex={0}
        role="group"
        aria-label={props.turning}
      />
    </PlotFrame>
  );
}
