// What the plots in three dimensions have in common around their scene.

import type { RefObject } from "react";
import type { AxisView } from "../../protocol";
import { AxisControl } from "../controls/AxisControl";
import { ColorsControl } from "../controls/ColorsControl";
import type { Table } from "../../draw/table";
import type { FollowingColors } from "../colors/mapColors";
import { PlotFrame, type PlotProps } from "../PlotFrame";
import { SectionStrip } from "../controls/SectionStrip";
import type { SceneRefs } from "./useScene";
import type { Streaming } from "../useStreams";

type ScenePlotProps = PlotProps & {
  kind: "surface" | "volume";
  ports: string[];
  streaming: Streaming;
  scene: SceneRefs;
  colors: RefObject<FollowingColors>;
  // All axes, the drawn ones first, and what these are called.
  axes: AxisView[];
  labels: string[];
  // The axes with a slider.
  cut: AxisView[];
  table: () => Table | null;
  // What it shows, and how it is turned, in words.
  label: string;
};

export function ScenePlot(props: ScenePlotProps) {
  const { element, port, settings, set, streaming, scene, colors, axes, labels, cut, label } = props;
  const { host, problem, exportAs } = scene;
  return (
    <PlotFrame
      {...props}
      streaming={{ ...streaming, seen: streaming.seen && problem === null, lost: problem ?? streaming.lost }}
      strip={<SectionStrip rest={cut} at={settings.at} set={set} />}
      controls={
        <>
          <AxisControl axes={axes} labels={labels} set={set} />
          <ColorsControl settings={settings} shown={() => colors.current.now.range} set={set} />
        </>
      }
      exportAs={(format) => exportAs(`${element.path} ${port}`, format)}
    >
      <div ref={host} className="plot-host plot-turning" tabIndex={0} role="group" aria-label={label} />
    </PlotFrame>
  );
}
