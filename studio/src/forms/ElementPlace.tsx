// The context of forms for one element.

import { type ReactNode, useMemo } from "react";

import { useSame } from "../state/useSame";
import { useStudio } from "../server/store";
import { axesOf } from "../model/leaf";
import { type Place, PlaceContext } from "../state/place";

const NONE = { axes: [], own: false };

export function ElementPlace({ id, children }: { id: string; children: ReactNode }) {
  const axes = useSame(({ elements, kinds, document }) => {
    const element = elements.get(id);
    return element === undefined ? NONE : axesOf(element, kinds.get(element.kind), document?.axes ?? []);
  });
  const timeUnit = useStudio((state) => state.document?.time_unit ?? "");
  const place = useMemo((): Place => ({ element: id, timeUnit, ...axes }), [id, timeUnit, axes]);
  return <PlaceContext.Provider value={place}>{children}</PlaceContext.Provider>;
}
