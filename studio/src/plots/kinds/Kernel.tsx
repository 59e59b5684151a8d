// The interaction kernel of an element over the lag between two positions, with its parameters as they are
// now: a curve over one axis, colours over two.

import { useMemo, useRef } from "react";
import type uPlot from "uplot";
import type { Live, Wish } from "../../streams";
import type { CursorAt } from "../chart/chartCursor";
import { drawColorBar } from "../colors/colorBar";
import { portColor } from "../colors/colors";
import { arrayTable } from "../export/exportCsv";
import { exportDrawing } from "../export/exportDrawing";
import { axisLabel, cell, commonScale, edges, points } from "../../model/axes";
import { axis, frame, type Look, mapFrame } from "../colors/look";
import { FollowingColors } from "../colors/mapColors";
import { paintHeat } from "../colors/paint";
import { PlotFrame, type PlotProps } from "../PlotFrame";
import { CalmRange, reading } from "../range";
import { RangeControl } from "../controls/RangeControl";
import { readPlane } from "../readPlane";
import { type ChartOptions, useChart } from "../chart/useChart";
import { useLatest } from "../useLatest";
import { useStreams } from "../useStreams";

const MOST = 600;
const ROOM = 0.05;

export function Kernel(props: PlotProps) {
  const { element, settings, visible, set } = props;
  const newest = useRef<Live | null>(null);
  const map = useRef<HTMLCanvasElement | null>(null);
  const colors = useRef(new FollowingColors("diverging"));
  const calm = useRef(new CalmRange(ROOM));
  const wishes = useMemo<Wish[]>(() => [{ type: "kernel", element: element.id, most: MOST }], [element.id]);
  const streaming = useStreams(wishes, visible, ([live]) => {
    newest.current = live ?? null;
    paint();
  });
  const form = streaming.forms[0] ?? null;
  const [x = null, y = null] = form?.axes ?? [];
  const plane = y !== null;

  const paint = () => {
    const live = newest.current;
    const [nx, ny] = live?.form?.shape ?? [];
    if (chart.current === null || live?.frame == null || nx === undefined) {
      return;
    }
    if (map.current !== null && ny !== undefined) {
      colors.current.follow(live.frame.values, "diverging", 0, settings.range);
      const { range, table } = colors.current.now;
      paintHeat(map.current, live.frame.values, nx, ny, range, table);
    }
    chart.current.setData(data());
    reread();
  };
  const data = (): uPlot.AlignedData => {
    if (x === null) {
      return [[], []];
    }
    if (y !== null) {
      return [edges(x), edges(y)];
    }
    const values = newest.current?.frame?.values;
    const places = points(x, form?.shape[0]);
    return [places, values?.length === places.length ? values : Array.from(places, () => null)];
  };
  const range = (low: number | null, high: number | null): [number, number] => {
    const extent =
      low !== null && high !== null && Number.isFinite(low) && Number.isFinite(high)
        ? ([low, high] as const)
        : null;
    return [...(settings.range ?? calm.current.next(extent, [0], performance.now()))];
  };
  const options = (look: Look): ChartOptions => {
    if (x === null || y === null) {
      return {
        ...frame(look),
        scales: {
          x: { time: false, range: () => (x === null ? [0, 1] : [x.lower, x.upper]) },
          left: { range: (_, low, high) => range(low, high) },
        },
        axes: [
          axis(look, { scale: "x", side: 2, ...(x === null ? {} : { label: axisLabel(x) }) }),
          axis(look, { scale: "left", side: 3, label: "weight" }),
        ],
        series: [
          {},
          {
            scale: "left",
            stroke: portColor("interaction", ["interaction"], look.shade),
            width: 2 * look.unit,
            points: { show: false },
          },
        ],
      };
    }
    return {
      ...mapFrame(look),
      scales: { x: { time: false, range: () => edges(x) }, y: { range: () => edges(y) } },
      axes: [
        axis(look, { scale: "x", side: 2, label: axisLabel(x), grid: false }),
        axis(look, { scale: "y", side: 3, label: axisLabel(y), grid: false }),
      ],
      hooks: { draw: [(self) => drawColorBar(self, look, colors.current.now)] },
    };
  };
  const repaint = useLatest(paint);
  const { host, chart, reread } = useChart(
    {
      options,
      data,
      label: `Interaction kernel of ${element.path}`,
      along: { x, y },
      extents: x !== null && y !== null ? commonScale(x, y) : null,
      read: (_, at) => readKernel(newest.current, at),
      attach: (self) => {
        if (plane) {
          const canvas = document.createElement("canvas");
          canvas.className = "plot-heat";
          self.under.append(canvas);
          map.current = canvas;
        }
        // The chart is known after this call.
        queueMicrotask(() => repaint.current());
        return () => {
          map.current = null;
        };
      },
    },
    JSON.stringify([element.id, x, y, settings.range]),
  );

  return (
    <PlotFrame
      {...props}
      kind="kernel"
      streaming={streaming}
      note="interaction kernel"
      controls={
        <RangeControl
          range={settings.range}
          shown={() => (plane ? colors.current.now.range : rangeOf(chart.current))}
          set={(next) => set({ range: next })}
        />
      }
      table={() => {
        const values = newest.current?.frame?.values;
        return form === null || values === undefined ? null : arrayTable(form, values, "weight");
      }}
      exportAs={(format) => {
        if (chart.current !== null) {
          const { width, height } = chart.current;
          const title = `${element.path} kernel`;
          const image = map.current === null ? {} : { image: map.current };
          void exportDrawing({ title, width, height, options, data: data(), ...image }, format);
        }
      }}
    >
      <div
        ref={host}
        className="plot-host"
        tabIndex={0}
        role="group"
        aria-label={`Drawing of the kernel of ${element.path}`}
      />
    </PlotFrame>
  );
}

function rangeOf(chart: uPlot | null): [number, number] {
  const { min, max } = chart?.scales["left"] ?? {};
  return [min ?? 0, max ?? 1];
}

function readKernel(live: Live | null, at: CursorAt): string {
  const [x, y] = live?.form?.axes ?? [];
  const [nx] = live?.form?.shape ?? [];
  if (x === undefined || nx === undefined || at.x === null) {
    return "";
  }
  if (y !== undefined) {
    return readPlane(live, x, y, at);
  }
  const value = live?.frame?.values[cell(x, nx, at.x)];
  const place = `${x.name} ${reading(at.x)}`;
  return value === undefined ? place : `${place}   ${reading(value)}`;
}
