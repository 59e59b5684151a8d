// An array over two axes as a surface; with more axes a section at positions on the others, or the maximum
// over them.

import { useMemo, useRef } from "react";
import { useStudio } from "../../store";
import type { Live, Wish } from "../../streams";
import { readContent } from "../../draw/cursorText";
import { tableOf } from "../../draw/table";
import { planeContent } from "../kinds/parts";
import { axisLabel, edges } from "../../draw/axis";
import { isPicture } from "../../model/ports";
import { FollowingColors, middleOf, scaleOf } from "../colors/mapColors";
import type { PlotProps } from "../PlotFrame";
import { ScenePlot } from "./ScenePlot";
import type { SceneFrame } from "./sceneFrame";
import { allAxes } from "../section";
import { surfaceSize } from "./sceneSize";
import type { SceneStage } from "./sceneStage";
import { useLevels } from "../useLevels";
import { usePorts } from "../usePorts";
import { useScene } from "./useScene";
import { useStreams } from "../useStreams";

const MOST = 100;

export function Surface(props: PlotProps) {
  const { element, port, settings, visible, set } = props;
  const { drawn, at } = settings;
  const kind = useStudio((state) => state.kinds.get(element.kind));
  const ports = usePorts(element, port, (axes) => axes.length > 1 && !isPicture(axes));
  const scale = scaleOf(settings.scale, kind, port);
  const newest = useRef<Live | null>(null);
  const colors = useRef(new FollowingColors());
  const levels = useLevels(element.id, port, () => redraw());
  const wishes = useMemo<Wish[]>(
    () => [{ type: "watch", element: element.id, port, most: MOST, drawn, at }],
    [element.id, port, drawn, at],
  );

  const content = () => planeContent(null, newest.current ?? undefined, port, () => colors.current.now);
  const show = (stage: SceneStage): SceneFrame | null => {
    const { form, frame } = newest.current ?? {};
    const [nx, ny] = form?.shape ?? [];
    const [x, y] = form?.axes ?? [];
    if (frame == null || nx === undefined || ny === undefined || x === undefined || y === undefined) {
      return null;
    }
    colors.current.follow(frame.values, scale, middleOf(scale.twoSided, levels.current), settings.range);
    const { range } = colors.current.now;
    const size = surfaceSize(x, y);
    stage.showSurface(frame.values, nx, ny, size, colors.current.now);
    return {
      size,
      axes: [
        { label: axisLabel(x), range: edges(x), along: x },
        { label: axisLabel(y), range: edges(y), along: y },
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
  const scene = useScene({
    label: `${port} of ${element.path} as a surface over ${names.join(" and ")}`,
    view: settings.view,
    keep: (view) => set({ view }),
    read: ([x = null, y = null]) => {
      const shown = content();
      return shown === null ? "" : readContent(shown, { x, y });
    },
    show,
  });
  const { redraw } = scene;

  return (
    <ScenePlot
      {...props}
      kind="surface"
      ports={ports}
      streaming={streaming}
      scene={scene}
      colors={colors}
      axes={allAxes(form)}
      labels={["First axis", "Second axis"]}
      cut={form?.rest ?? []}
      label={`Surface of ${element.path}; the arrow keys turn it`}
      table={() => {
        const shown = content();
        return shown === null ? null : tableOf([shown]);
      }}
    />
  );
}
