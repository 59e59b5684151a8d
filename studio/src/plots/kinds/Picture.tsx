// A picture: two dimensions and the channels red, green and blue.

import { useMemo, useRef } from "react";
import type uPlot from "uplot";
import type { AxisView } from "../../protocol";
import type { Live, Wish } from "../../streams";
import type { CursorAt } from "../chart/chartCursor";
import { arrayTable } from "../export/exportCsv";
import { exportDrawing } from "../export/exportDrawing";
import { axisLabel, cell, commonScale, edges } from "../../model/axes";
import { isPicture } from "../../model/ports";
import { axis, frame, type Look } from "../colors/look";
import { paintPicture } from "../colors/paint";
import { PlotFrame, type PlotProps } from "../PlotFrame";
import { reading } from "../range";
import { type ChartOptions, useChart } from "../chart/useChart";
import { useLatest } from "../useLatest";
import { usePorts } from "../usePorts";
import { useStreams } from "../useStreams";

const MOST = 256;
const UNKNOWN: AxisView = { key: "", name: "", lower: 0, upper: 1, samples: 2, periodic: false, unit: "" };
const CHANNELS = 3;

export function Picture(props: PlotProps) {
  const { element, port, visible } = props;
  const ports = usePorts(element, port, isPicture);
  const picture = useRef<HTMLCanvasElement | null>(null);
  const newest = useRef<Live | null>(null);
  const wishes = useMemo<Wish[]>(
    () => [{ type: "watch", element: element.id, port, most: MOST }],
    [element.id, port],
  );
  const streaming = useStreams(wishes, visible, ([live]) => {
    newest.current = live ?? null;
    paint();
  });
  const form = streaming.forms[0] ?? null;
  const [x = UNKNOWN, y = UNKNOWN] = form?.axes ?? [];

  const paint = () => {
    const live = newest.current;
    const [nx, ny] = live?.form?.shape ?? [];
    if (
      picture.current !== null &&
      live?.frame != null &&
      live.form?.channels === true &&
      nx !== undefined &&
      ny !== undefined
    ) {
      paintPicture(picture.current, live.frame.values, nx, ny);
      reread();
    }
  };
  const options = (look: Look): ChartOptions => {
    const base = frame(look);
    return {
      ...base,
      cursor: { ...base.cursor, y: true, points: { show: false } },
      // The rows of a picture count from the top.
      scales: { x: { time: false, range: () => edges(x) }, y: { range: () => edges(y), dir: -1 } },
      axes: [
        axis(look, { scale: "x", side: 2, label: axisLabel(x), grid: false }),
        axis(look, { scale: "y", side: 3, label: axisLabel(y), grid: false }),
      ],
      series: [{}, { scale: "y", paths: () => null, points: { show: false } }],
    };
  };
  const data = (): uPlot.AlignedData => [edges(x), edges(y)];
  const repaint = useLatest(paint);
  const { host, chart, reread } = useChart(
    {
      options,
      data,
      along: { x, y },
      extents: commonScale(x, y),
      label: `Axes around ${port} of ${element.path}`,
      read: (_, at) => readAt(newest.current, x, y, at),
      attach: (self) => {
        const canvas = document.createElement("canvas");
        canvas.className = "plot-heat";
        canvas.setAttribute("role", "img");
        canvas.setAttribute("aria-label", `Picture at ${port} of ${element.path}`);
        self.under.append(canvas);
        picture.current = canvas;
        repaint.current();
        return () => {
          picture.current = null;
        };
      },
    },
    JSON.stringify([element.id, port, x, y]),
  );

  return (
    <PlotFrame
      {...props}
      kind="picture"
      ports={ports}
      streaming={streaming}
      table={() => {
        const { frame, form: shown } = newest.current ?? {};
        return frame == null || shown == null ? null : arrayTable(shown, frame.values, port);
      }}
      exportAs={(format) => {
        if (chart.current !== null && picture.current !== null) {
          const { width, height } = chart.current;
          const title = `${element.path} ${port}`;
          void exportDrawing({ title, width, height, options, data: data(), image: picture.current }, format);
        }
      }}
    >
      <div
        ref={host}
        className="plot-host"
        tabIndex={0}
        role="group"
        aria-label={`Drawing of ${element.path}`}
      />
    </PlotFrame>
  );
}

// The colour at a position, its channels from 0 to 1.
function readAt(live: Live | null, x: AxisView, y: AxisView, at: CursorAt): string {
  const [nx, ny] = live?.form?.shape ?? [];
  const words = [
    ...(at.x === null ? [] : [`${x.name} ${reading(at.x)}`]),
    ...(at.y === null ? [] : [`${y.name} ${reading(at.y)}`]),
  ];
  if (at.x !== null && at.y !== null && nx !== undefined && ny !== undefined) {
    const from = CHANNELS * (cell(x, nx, at.x) * ny + cell(y, ny, at.y));
    const colour = [...(live?.frame?.values.subarray(from, from + CHANNELS) ?? [])];
    words.push(...colour.map((value, i) => `${"rgb"[i]} ${reading(value)}`));
  }
  return words.join("   ");
}
