// How a box and its ports look while a connection is made. The marks are attributes that are set beside
// React: hundreds of boxes that React drew again would light up too late.

import { type RefObject, useLayoutEffect } from "react";

import type { End } from "../model/ends";
import { bestOf, stateAt, useWiring, type Wiring } from "./wiring";

// A port, and the id of its handle.
export type MarkedPort = End & { handle: string };

export function useFitMarks(holder: RefObject<HTMLElement | null>, ports: MarkedPort[]): void {
  // also after every drawing: React made new handles
  useLayoutEffect(() => {
    const mark = (wiring: Wiring | null) =>
      holder.current !== null && setMarks(holder.current, ports, wiring);
    const { wiring } = useWiring.getState();
    if (wiring !== null) {
      mark(wiring);
    }
    return useWiring.subscribe((now, before) => {
      if (now.wiring?.fits !== before.wiring?.fits) {
        mark(now.wiring);
      }
    });
  });
}

function setMarks(holder: HTMLElement, ports: MarkedPort[], wiring: Wiring | null): void {
  const states = ports.map(({ handle, ...end }) => [handle, stateAt(end, wiring)] as const);
  const all = new Map(states);
  put(holder, "data-wiring", wiring?.fits == null ? "" : bestOf(states.flatMap(([, state]) => state || [])));
  for (const handle of holder.querySelectorAll(".react-flow__handle")) {
    put(handle, "data-fits", all.get(handle.getAttribute("data-handleid") ?? "") ?? "");
  }
}

function put(element: Element, name: string, value: string): void {
  if (value === "") {
    element.removeAttribute(name);
  } else {
    element.setAttribute(name, value);
  }
}
