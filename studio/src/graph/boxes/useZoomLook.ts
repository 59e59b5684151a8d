// Applies the level of detail to the canvas once its zoom rests: to change the size of hundreds of names
// costs a picture of the browser, and during a movement the browser only scales what it has.

import { useStoreApi } from "@xyflow/react";
import { type RefObject, useLayoutEffect } from "react";
import { lookAt, useLook, useMoving } from "./zoom";

const REST_MS = 160;
// On a slow machine the steps of one movement are at most this far apart.
const STEP_MS = 300;

export function useZoomLook(around: RefObject<HTMLElement | null>): void {
  const flow = useStoreApi();
  useLayoutEffect(() => {
    let timer = 0;
    let last = 0;
    const apply = () => {
      const { level, text, numbers, lines } = lookAt(flow.getState().transform[2]);
      const before = useLook.getState();
      around.current?.setAttribute("data-level", level);
      around.current?.toggleAttribute("data-numbers", numbers);
      around.current?.toggleAttribute("data-lines", lines);
      around.current?.style.setProperty("--graph-text", `${text}px`);
      if (before.level !== level || before.text !== text) {
        useLook.setState({ level, text, numbers, lines });
      }
    };
    apply();
    const rest = () => {
      apply();
      useMoving.setState({ moving: false });
    };
    const leave = flow.subscribe((state, before) => {
      if (state.transform !== before.transform) {
        const step = performance.now() - last;
        last += step;
        window.clearTimeout(timer);
        timer = window.setTimeout(rest, step < STEP_MS ? Math.max(REST_MS, 2 * step) : REST_MS);
        useMoving.setState({ moving: true });
      }
    });
    return () => {
      window.clearTimeout(timer);
      leave();
      useMoving.setState({ moving: false });
    };
  }, [flow, around]);
}
