// An array over two axes as a surface; with more axes a section at positions on the others, or the maximum
// over them.

import { useMemo, useRef } from "react";
import { useStudio } from "../store";
import type { Live, Wish } from "../streams";
import { AxisControl } from "./AxisControl";
import { ColorsControl } from "./ColorsControl";
import { plane } from "./exportCsv";
import { axisLabel, commonScale, edges, isPicture, points } from "./kinds";
import { FollowingColors, middleOf, scaleOf } from "./mapColors";
import { PlotFrame, type PlotProps } from "./PlotFrame";
import type { SceneFrame } from "./sceneFrame";
import { allAxes } from "./section";
import { SectionStrip } from "./SectionStrip";
import type { SceneStage } from "./sceneStage";
import { useLevels } from "./useLevels";
import { usePorts } from "./usePorts";
import { useScene } from "./useScene";
import { useStreams } from "./useStreams";

const MOST = 100;
const HEIGHT = 0.5;

export function Surface(props: PlotProps) {
  const { element, port, settings, visible, set } = props;
  const { drawn, at } = settings;
  const kind = useStudio((state) => state.kinds.get(element.kind));
  const ports = usePorts(element, port, (axes) => axes.length > 1 && !isPicture(axes));
  const { name, twoSided } = scaleOf(settings.scale, kind, port);
  const newest = useRef<Live | null>(null);
  const colors = useRef(new FollowingColors(name));
  const levels = useLevels(element.id, port, () => redraw());
  const wishes = useMemo<Wish[]>(
    () => [{ type: "watch", element: element.id, port, most: MOST, drawn, at }],
    [element.id, port, drawn, at],
  );

  const show = (stage: SceneStage): SceneFrame | null => {
    const { form, frame } = newest.current ?? {};
    const [nx, ny] = form?.shape ?? [];
    const [x, y] = form?.axes ?? [];
    if (frame == null || nx === undefined || ny === undefined || x === undefined || y === undefined) {
      return null;
    }
    colors.current.follow(frame.values, name, middleOf(twoSided, levels.current), settings.range);
    const { range } = colors.current.now;
    const [wide, deep] = commonScale(x, y) ?? [1, 1];
    const longest = Math.max(wide, deep);
    const size = [wide / longest, deep / longest, HEIGHT] as const;
    stage.showSurface(frame.values, nx, ny, size, colors.current.now);
    return {
      size,
      axes: [
        { label: axisLabel(x), range: edges(x) },
        { label: axisLabel(y), range: edges(y) },
        { label: port, range },
      ],
      bar: null,
    };
  };
  const streaming = useStreams(wishes, visible, ([live]) => {
    newest.current = live ?? null;
    redraw();
  });
  const form = streaming.forms[0] ?? null;
  const names = form?.axes.map((axis) => axis.name) ?? [];
  const { host, redraw, problem, exportAs } = useScene({
    label: `${port} of ${element.path} as a surface over ${names.join(" and ")}`,
    view: settings.view,
    keep: (view) => set({ view }),
    show,
  });

  return (
    <PlotFrame
      {...props}
      kind="surface"
      ports={ports}
      streaming={{ ...streaming, seen: streaming.seen && problem === null, lost: problem ?? streaming.lost }}
      strip={<SectionStrip rest={form?.rest ?? []} at={at} set={set} />}
      controls={
        <>
          <AxisControl axes={allAxes(form)} labels={["First axis", "Second axis"]} set={set} />
          <ColorsControl settings={settings} shown={() => colors.current.now.range} set={set} />
        </>
      }
      table={() => {
        const { frame, form: shown } = newest.current ?? {};
        const [x, y] = shown?.axes ?? [];
        return frame == null || shown == null || x === undefined || y === undefined
          ? null
          : {
              header: [axisLabel(x), axisLabel(y), port],
              columns: plane(points(x, shown.shape[0]), points(y, shown.shape[1]), frame.values),
            };
      }}
      exportAs={(format) => exportAs(`${element.path} ${port}`, format)}
    >
      <div
        ref={host}
        className="plot-host plot-turning"
        tabIndex={0}
        role="group"
        aria-label={`Surface of ${element.path}; the arrow keys turn it`}
      />
    </PlotFrame>
  );
}
