// A picture: two dimensions and the channels red, green and blue.

import { useEffect, useMemo, useRef } from "react";
import type { Live, Wish } from "../streams";
import { exportPicture } from "./exportPng";
import { isPicture } from "./kinds";
import { paintPicture } from "./paint";
import { PlotFrame, type PlotProps } from "./PlotFrame";
import { usePorts } from "./usePorts";
import { useStreams } from "./useStreams";

const MOST = 256;

export function Picture(props: PlotProps) {
  const { element, port, visible } = props;
  const ports = usePorts(element, port, isPicture);
  const canvas = useRef<HTMLCanvasElement>(null);
  const newest = useRef<Live | null>(null);
  const paint = () => {
    const live = newest.current;
    const [nx, ny] = live?.form?.shape ?? [];
    if (
      canvas.current !== null &&
      live?.frame != null &&
      live.form?.channels === true &&
      nx !== undefined &&
      ny !== undefined
    ) {
      paintPicture(canvas.current, live.frame.values, nx, ny);
    }
  };
  const wishes = useMemo<Wish[]>(
    () => [{ type: "watch", element: element.id, port, most: MOST }],
    [element.id, port],
  );
  const streaming = useStreams(wishes, visible, ([live]) => {
    newest.current = live ?? null;
    paint();
  });
  useEffect(paint, [streaming.seen]);

  return (
    <PlotFrame
      {...props}
      kind="picture"
      ports={ports}
      streaming={streaming}
      exportAs={() => canvas.current !== null && exportPicture(`${element.path} ${port}`, canvas.current)}
    >
      <canvas
        ref={canvas}
        className="plot-picture"
        role="img"
        aria-label={`Picture at ${port} of ${element.path}`}
      />
    </PlotFrame>
  );
}
