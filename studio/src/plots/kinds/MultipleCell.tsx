// One of the small multiples: the values of one element, on the scales that all of them share.

import { type RefObject, useEffect, useRef } from "react";
import type uPlot from "uplot";
import type { AxisView, ElementView } from "../../protocol";
import type { Live } from "../../streams";
import type { CursorAt } from "../chart/chartCursor";
import { portColor } from "../colors/colors";
import type { PlotDrawing } from "../export/exportDrawing";
import { axisLabel, cell, commonScale, edges, points } from "../../model/axes";
import { axis, frame, type Look, mapFrame } from "../colors/look";
import type { FollowingColors } from "../colors/mapColors";
import { paintHeat } from "../colors/paint";
import { reading } from "../range";
import { readPlane } from "../readPlane";
import { type ChartOptions, useChart } from "../chart/useChart";
import { useLatest } from "../useLatest";

// The scales of all cells: of values, of time, and of colours.
export type SharedScales = {
  range: [number, number];
  span: [number, number];
  colors: FollowingColors;
};

// What a cell does for the plot: draw its values, and describe its drawing for an export.
export type CellHandle = { paint: () => void; drawing: () => PlotDrawing | null; host: HTMLElement | null };

type CellProps = {
  element: ElementView;
  port: string;
  timeLabel: string;
  // The axes that are drawn: none for a time course, one for a curve, two for colours.
  axes: AxisView[];
  live: () => Live | null;
  scales: RefObject<SharedScales>;
  handles: RefObject<Map<string, CellHandle>>;
  open: () => void;
};

export function MultipleCell({ element, port, timeLabel, axes, live, scales, handles, open }: CellProps) {
  const map = useRef<HTMLCanvasElement | null>(null);
  const [x, y] = axes;

  const data = (): uPlot.AlignedData => {
    const { form, history, frame: newest } = live() ?? {};
    if (x === undefined) {
      return [history?.times ?? [], history?.values ?? []];
    }
    if (y !== undefined) {
      return [edges(x), edges(y)];
    }
    const places = points(x, form?.shape[0]);
    return [places, newest?.values.length === places.length ? newest.values : Array.from(places, () => null)];
  };
  const options = (look: Look): ChartOptions => {
    const label = x === undefined ? timeLabel : axisLabel(x);
    const labels = [axis(look, { scale: "x", side: 2, label, grid: y === undefined })];
    if (x !== undefined && y !== undefined) {
      return {
        ...mapFrame(look),
        padding: frame(look).padding ?? [0, 0, 0, 0],
        scales: { x: { time: false, range: () => edges(x) }, y: { range: () => edges(y) } },
        axes: [...labels, axis(look, { scale: "y", side: 3, label: axisLabel(y), grid: false })],
      };
    }
    return {
      ...frame(look),
      scales: {
        x: { time: false, range: () => (x === undefined ? scales.current.span : [x.lower, x.upper]) },
        y: { range: () => scales.current.range },
      },
      axes: [...labels, axis(look, { scale: "y", side: 3 })],
      series: [
        {},
        {
          scale: "y",
          stroke: portColor(port, [port], look.shade),
          width: 1.5 * look.unit,
          points: { show: false },
        },
      ],
    };
  };
  const paint = () => {
    const { form, frame: newest } = live() ?? {};
    const [nx, ny] = form?.shape ?? [];
    if (map.current !== null && newest != null && nx !== undefined && ny !== undefined) {
      const { range, table } = scales.current.colors.now;
      paintHeat(map.current, newest.values, nx, ny, range, table);
    }
    chart.current?.setData(data());
    reread();
  };
  const repaint = useLatest(paint);
  const { host, chart, reread } = useChart(
    {
      options,
      data,
      along: x === undefined ? { x: "time" } : { x, y: y ?? null },
      extents: x !== undefined && y !== undefined ? commonScale(x, y) : null,
      label: `${port} of ${element.path}`,
      read: (self, at) => readCell(self, live(), axes, at),
      attach: (self) => {
        if (y !== undefined) {
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
    JSON.stringify([element.id, port, axes, timeLabel]),
  );
  const drawing = useLatest((): PlotDrawing | null => {
    const image = map.current === null ? {} : { image: map.current };
    const { width, height } = chart.current ?? {};
    return width === undefined || height === undefined
      ? null
      : { title: element.path, width, height, options, data: data(), ...image };
  });
  useEffect(() => {
    const all = handles.current;
    all.set(element.id, {
      paint: () => repaint.current(),
      drawing: () => drawing.current(),
      host: host.current,
    });
    return () => void all.delete(element.id);
  }, [element.id, handles, host, repaint, drawing]);

  return (
    <div className="plot-cell">
      <button type="button" className="plot-cell-name one-line" title={`Plot ${element.path}`} onClick={open}>
        {element.path}
      </button>
      <div className="plot-cell-body">
        <div ref={host} className="plot-host" />
      </div>
    </div>
  );
}

function readCell(chart: uPlot, live: Live | null, [x, y]: AxisView[], at: CursorAt): string {
  if (x !== undefined && y !== undefined) {
    return readPlane(live, x, y, at);
  }
  const index =
    x === undefined ? chart.cursor.idx : at.x === null ? null : cell(x, chart.data[0].length, at.x);
  const [place, value] = index == null ? [] : [chart.data[0][index], chart.data[1]?.[index]];
  return place === undefined || value == null
    ? ""
    : `${x === undefined ? "t" : x.name} ${reading(place)}   ${reading(value)}`;
}
