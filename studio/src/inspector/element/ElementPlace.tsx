// The context of forms for one element.

import { type ReactNode, useMemo } from "react";

import { useStudio } from "../../store";
import { axesOf } from "../parameters/leaf";
import { type Place, PlaceContext, useAxes } from "../place";

export function ElementPlace({ id, children }: { id: string; children: ReactNode }) {
  const element = useStudio((state) => state.elements.get(id));
  const kind = useStudio((state) => state.kinds.get(element?.kind ?? ""));
  const { axes, timeUnit } = useAxes();
  const found = element === undefined ? "" : JSON.stringify(axesOf(element, kind, axes));
  const place = useMemo(
    (): Place => ({
      element: id,
      timeUnit,
      ...(JSON.parse(found || '{"axes": [], "own": false}') as Pick<Place, "axes" | "own">),
    }),
    [id, timeUnit, found],
  );
  return <PlaceContext.Provider value={place}>{children}</PlaceContext.Provider>;
}
