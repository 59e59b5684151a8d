// The levels of a port as they are now, without rendering when a slider moves one.

import { type RefObject, useEffect, useRef } from "react";
import { useStudio } from "../server/store";
import { type Level, levelsOf } from "../model/levels";
import { useLatest } from "./useLatest";

export function useLevels(element: string, port: string, changed: () => void): RefObject<Level[]> {
  const levels = useRef<Level[]>(currentLevels(element, port));
  const tell = useLatest(changed);
  useEffect(() => {
    levels.current = currentLevels(element, port);
    return useStudio.subscribe((state, before) => {
      if (state.document === before.document) {
        return;
      }
      const next = currentLevels(element, port);
      if (JSON.stringify(next) !== JSON.stringify(levels.current)) {
        levels.current = next;
        tell.current();
      }
    });
  }, [element, port, tell]);
  return levels;
}

function currentLevels(element: string, port: string): Level[] {
  const { document, elements, kinds } = useStudio.getState();
  const found = elements.get(element);
  return document === null || found === undefined
    ? []
    : levelsOf(document, found, kinds.get(found.kind), port);
}
