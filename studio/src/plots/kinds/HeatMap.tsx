// A port over two axes as colours; with more axes a section at positions on the others, or the maximum over
// them.

import { useStudio } from "../../store";
import { scaleOf } from "../colors/mapColors";
import { PlaneMap } from "./PlaneMap";
import type { PlotProps } from "../PlotFrame";
import { usePorts } from "../usePorts";

const MOST = 256;

export function HeatMap(props: PlotProps) {
  const { element, port, settings } = props;
  const { drawn, at } = settings;
  const type = useStudio((state) => state.kinds.get(element.kind));
  const ports = usePorts(element, port, (axes) => axes.length > 1);
  return (
    <PlaneMap
      {...props}
      kind="heat"
      shown={port}
      wish={{ type: "watch", element: element.id, port, most: MOST, drawn, at }}
      ports={ports}
      colours={scaleOf(settings.scale, type, port)}
      injects={element.pushable}
    />
  );
}
