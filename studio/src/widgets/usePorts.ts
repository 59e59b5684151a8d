// The ports of an element whose axes fit a kind of plot; the present one is always among them.

import type { AxisView, ElementView } from "../protocol";
import { useStudio } from "../server/store";
import { portAxes, portsOf } from "../model/ports";

export function usePorts(element: ElementView, port: string, fits: (axes: AxisView[]) => boolean): string[] {
  const joined = useStudio(({ document }) =>
    portsOf(element)
      .filter(
        (other) => other === port || (document !== null && fits(portAxes(document, element, other) ?? [])),
      )
      .join("\n"),
  );
  return joined.split("\n");
}
