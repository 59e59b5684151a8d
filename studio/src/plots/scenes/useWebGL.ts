// A place that WebGL draws in: what draws is loaded when the place is first shown.

import { type RefObject, useEffect, useRef, useState } from "react";

import { useLatest } from "../../widgets/useLatest";

// `load` resolves to a function that begins to draw, and returns one that ends it. `problem` is why nothing
// can be drawn; empty: it can.
export function useWebGL(
  noWebGL: string,
  load: () => Promise<(place: HTMLElement) => () => void>,
): { host: RefObject<HTMLDivElement | null>; problem: string } {
  const host = useRef<HTMLDivElement>(null);
  const [problem, setProblem] = useState("");
  const latest = useLatest({ noWebGL, load });
  useEffect(() => {
    const place = host.current;
    let end: (() => void) | null = null;
    let ended = false;
    const begin = async () => {
      if (document.createElement("canvas").getContext("webgl2") === null) {
        setProblem(latest.current.noWebGL);
        return;
      }
      const draw = await latest.current.load();
      if (!ended && place !== null) {
        end = draw(place);
      }
    };
    begin().catch((error: unknown) => {
      console.error(error);
      setProblem(error instanceof Error ? error.message : String(error));
    });
    return () => {
      ended = true;
      end?.();
    };
  }, [latest]);
  return { host, problem };
}

// Draws at most once for each picture of the browser: when it is asked to, and in a place of another size.
export function onPictures(place: Element, draw: () => void): { redraw: () => void; end: () => void } {
  let due = 0;
  const redraw = () => {
    due ||= requestAnimationFrame(() => {
      due = 0;
      draw();
    });
  };
  const sizes = new ResizeObserver(redraw);
  sizes.observe(place);
  const end = () => {
    cancelAnimationFrame(due);
    sizes.disconnect();
  };
  return { redraw, end };
}
