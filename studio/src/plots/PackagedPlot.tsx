// A plot that the ES module of an installed package draws onto a canvas.

import { useComputedColorScheme } from "@mantine/core";
import { useEffect, useMemo, useRef, useState } from "react";
import type { ListedProblem, PlotView } from "../protocol";
import type { Live, Wish } from "../server/streams";
import { arrayTable } from "../draw/table";
import { exportPicture } from "./export/exportDrawing";
import { fits } from "../model/ports";
import { paperInk } from "../draw/ink";
import { pageInk } from "../widgets/look";
import type { Ink } from "../draw/ink";
import { attempt, load, packagedFrame, type PlotModule, problemOf } from "./kinds/packaged";
import { PlotFrame, type PlotProps } from "./PlotFrame";
import { useLatest } from "../widgets/useLatest";
import { usePorts } from "../widgets/usePorts";
import { useStreams } from "./useStreams";

const MOST_POINTS = 600;
const MOST_CELLS = 256;
const EXPORT_RATIO = 2;

export function PackagedPlot(props: PlotProps & { plot: PlotView }) {
  const { element, port, visible, plot } = props;
  const ports = usePorts(element, port, (axes) => fits(plot, axes));
  const host = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const newest = useRef<Live | null>(null);
  const [module, setModule] = useState<PlotModule | null>(null);
  const [problem, setProblem] = useState<ListedProblem | null>(null);
  const scheme = useComputedColorScheme("light", { getInitialValueInEffect: false });

  const tell = (next: ListedProblem | null) =>
    setProblem((known) => (known?.what === next?.what ? known : next));
  const drawOn = (target: HTMLCanvasElement, look: Ink, ratio: number): boolean => {
    const { form = null, frame = null } = newest.current ?? {};
    const { clientWidth: width, clientHeight: height } = host.current ?? { clientWidth: 0, clientHeight: 0 };
    if (module === null || form === null || frame === null || width === 0 || height === 0) {
      return false;
    }
    const [across, down] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (target.width !== across || target.height !== down) {
      target.width = across;
      target.height = down;
    }
    const size = { width, height, ratio };
    return attempt(plot, () => module.draw(target, packagedFrame(form, frame, look, size)), tell);
  };
  const paint = () => {
    if (canvas.current !== null && drawOn(canvas.current, pageInk(), devicePixelRatio)) {
      tell(null);
    }
  };
  const repaint = useLatest(paint);
  const wishes = useMemo<Wish[]>(
    () => [{ type: "watch", element: element.id, port, most: plot.axes === 1 ? MOST_POINTS : MOST_CELLS }],
    [element.id, port, plot.axes],
  );
  const streaming = useStreams(wishes, visible, ([live]) => {
    newest.current = live ?? null;
    paint();
  });

  useEffect(() => {
    let ended = false;
    load(plot).then(
      (found) => ended || setModule(found),
      (error: unknown) => {
        console.error(error);
        if (!ended) {
          setProblem(problemOf(plot, error));
        }
      },
    );
    return () => {
      ended = true;
    };
  }, [plot]);
  useEffect(() => {
    const drawn = canvas.current;
    return () => {
      if (drawn !== null && module?.dispose !== undefined) {
        attempt(
          plot,
          () => module.dispose?.(drawn),
          () => undefined,
        );
      }
    };
  }, [plot, module]);
  useEffect(() => {
    repaint.current();
    const observer = new ResizeObserver(() => repaint.current());
    if (host.current !== null) {
      observer.observe(host.current);
    }
    return () => observer.disconnect();
  }, [module, scheme, repaint]);

  const form = streaming.forms[0] ?? null;
  return (
    <PlotFrame
      {...props}
      kind={plot.name}
      ports={ports}
      streaming={{
        ...streaming,
        seen: streaming.seen && problem === null,
        lost: problem ?? streaming.lost,
      }}
      note={form !== null && form.folded.length > 0 ? `max over ${form.folded.join(", ")}` : ""}
      table={() => {
        const { frame, form: shown } = newest.current ?? {};
        return frame == null || shown == null ? null : arrayTable(shown, frame.values, port);
      }}
      exportAs={(format) => {
        const sheet = document.createElement("canvas");
        if (drawOn(sheet, paperInk(1), EXPORT_RATIO)) {
          exportPicture(`${element.path} ${port}`, sheet, format);
          attempt(plot, () => module?.dispose?.(sheet), tell);
        }
      }}
    >
      <div ref={host} className="plot-host">
        <canvas
          ref={canvas}
          className="plot-packaged"
          role="img"
          aria-label={`${plot.title} of ${port} of ${element.path}`}
        />
      </div>
    </PlotFrame>
  );
}
