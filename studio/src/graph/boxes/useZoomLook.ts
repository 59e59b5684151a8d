// Applies the level of detail to the canvas once its zoom rests: to change the size of hundreds of names
// costs a picture of the browser, and during a movement the browser only scales what it has.

import { useReactFlow, useStoreApi } from "@xyflow/react";
import { type RefObject, useCallback, useEffect, useLayoutEffect, useRef } from "react";
import type { MovedView } from "./movedView";
import type { SceneNode } from "../../architecture/nodes";
import { lookAt, useInView, useLook } from "./zoom";

const REST_MS = 160;

export function useZoomLook(
  around: RefObject<HTMLElement | null>,
  nodes: readonly SceneNode[],
  movedView: MovedView,
): void {
  const flow = useStoreApi();
  const { getIntersectingNodes } = useReactFlow();
  const isMoving = useRef(false);
  const look = useCallback(() => {
    const { transform, width, height } = flow.getState();
    const [x, y, zoom] = transform;
    const view = { x: -x / zoom, y: -y / zoom, width: width / zoom, height: height / zoom };
    useInView.setState({ ids: new Set(getIntersectingNodes(view).map(({ id }) => id)) });
  }, [flow, getIntersectingNodes]);
  useEffect(() => {
    if (!isMoving.current) {
      look();
    }
  }, [nodes, look]);
  useLayoutEffect(() => {
    let timer = 0;
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
      isMoving.current = false;
      apply();
      look();
    };
    const leave = flow.subscribe((state, before) => {
      if (state.transform !== before.transform) {
        window.clearTimeout(timer);
        const isFirst = useInView.getState().ids.size === 0;
        timer = window.setTimeout(() => movedView.atRest(rest), isFirst ? 0 : REST_MS);
        isMoving.current = true;
      }
    });
    return () => {
      window.clearTimeout(timer);
      leave();
      useInView.setState({ ids: new Set() });
    };
  }, [flow, around, look, movedView]);
}
