// An array over two axes as a surface; with more axes a section at positions on the others, or the maximum
// over them.

import { axisLabel, edges } from "../../draw/axis";
import { readContent } from "../../draw/cursorText";
import { tableOf } from "../../draw/table";
import type { Live } from "../../server/streams";
import { planeIn } from "../kinds/parts";
import type { PlotProps } from "../PlotFrame";
import { allAxes } from "../../model/section";
import type { SceneFrame } from "../export/sceneFrame";
import { planeOf, ScenePlot, type ShownScene } from "./ScenePlot";
import { surfaceSize } from "./sceneSize";

const MOST = 100;

export function Surface(props: PlotProps) {
  const { element, port, settings } = props;
  const { drawn, at } = settings;
  const show = ([live]: Live[], { stage, colors }: ShownScene): SceneFrame | null => {
    const plane = planeIn(live);
    if (plane === null) {
      return null;
    }
    const { x, y, map } = plane;
    const shown = colors(map.values);
    const size = surfaceSize(x, y);
    stage.showSurface(map.values, map.nx, map.ny, size, shown);
    const side = (axis: typeof x) => ({ label: axisLabel(axis), range: edges(axis), along: axis });
    return { size, axes: [side(x), side(y), { label: port, range: shown.range }], bar: null };
  };
  return (
    <ScenePlot
      {...props}
      kind="surface"
      least={2}
      wishes={[{ type: "watch", element: element.id, port, most: MOST, drawn, at }]}
      show={show}
      read={([live], [x = null, y = null]) => {
        const shown = planeOf(live, port);
        return shown === null ? "" : readContent(shown, { x, y });
      }}
      table={([live]) => {
        const shown = planeOf(live, port);
        return shown === null ? null : tableOf([shown]);
      }}
      axes={allAxes}
      labels={["First axis", "Second axis"]}
      cut={(form) => form?.rest ?? []}
      label={(names) => `${port} of ${element.path} as a surface over ${names.join(" and ")}`}
      turning={`Surface of ${element.path}; the arrow keys turn it`}
    />
  );
}
