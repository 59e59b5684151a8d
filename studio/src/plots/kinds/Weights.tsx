// The weights of an element that do not learn: an array parameter from a source to a target as colours, white
// at 0. Weights that learn are a port.

import { useStudio } from "../../store";
import { type WeightsView, weightsOf } from "../../model/ports";
import { PlaneMap } from "./PlaneMap";
import type { PlotProps } from "../PlotFrame";

const MOST = 256;

export function Weights(props: PlotProps) {
  const { element, settings } = props;
  const { drawn, at, scale } = settings;
  const found = useStudio(({ document, kinds }) =>
    JSON.stringify(document === null ? [] : weightsOf(document, element, kinds.get(element.kind))),
  );
  const [{ name, ports }] = [
    ...(JSON.parse(found) as WeightsView[]),
    { name: "", ports: [] as string[] },
  ] as const;
  const chosen = scale === "auto" ? "diverging" : scale;
  return (
    <PlaneMap
      {...props}
      kind="weights"
      shown={name}
      wish={{ type: "weights", element: element.id, parameter: name, most: MOST, drawn, at }}
      note={`${name} over ${ports.join(" and ")}`}
      colours={{ name: chosen, twoSided: chosen === "diverging" }}
      injects={false}
    />
  );
}
