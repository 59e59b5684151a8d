// Values over time: of nodes, and of arrays their maximum, mean, or value at a place. Several in one plot.

import { CloseButton, useComputedColorScheme } from "@mantine/core";
import { useEffect, useMemo, useRef } from "react";
import type uPlot from "uplot";
import { isRecord } from "../../replay/replay";
import { useStudio } from "../../store";
import type { Live, Wish } from "../../streams";
import { curveColor } from "../colors/colors";
import { CourseControls } from "../controls/CourseControls";
import { exportDrawing } from "../export/exportDrawing";
import { portAxes } from "../../model/ports";
import { axis, frame, type Look } from "../colors/look";
import { drawMoment } from "../chart/momentLine";
import { PlotFrame, type PlotProps } from "../PlotFrame";
import { CalmRange, reading } from "../range";
import type { TraceSetting } from "../settings";
import { drawWindows, timeWindows } from "../timeWindows";
import { sideBySide, timeRange, traceLabel } from "../traces";
import { traceOf } from "../controls/TraceControl";
import { type ChartOptions, useChart } from "../chart/useChart";
import { useLatest } from "../useLatest";
import { useStreams } from "../useStreams";

const ROOM = 0.03;

export function TimeCourse(props: PlotProps) {
  const { element, port, settings, visible, set } = props;
  const scheme = useComputedColorScheme("light", { getInitialValueInEffect: false });
  const timeUnit = useStudio((state) => state.document?.time_unit ?? "");
  const own = useStudio(({ document }) =>
    JSON.stringify(traceOf(element.id, port, (document && portAxes(document, element, port)) || [], "max")),
  );
  const kept = JSON.stringify(settings.traces);
  const traces = useMemo(
    () => (kept === "[]" ? [JSON.parse(own) as TraceSetting] : (JSON.parse(kept) as TraceSetting[])),
    [own, kept],
  );
  const labels = useStudio((state) =>
    traces
      .map((trace) =>
        traceLabel(
          trace,
          trace.element === element.id ? "" : (state.elements.get(trace.element)?.path ?? "gone"),
        ),
      )
      .join("\n"),
  ).split("\n");

  // A line marks the moment of the past that the page shows.
  const moment = useStudio((state) => state.clock?.timeline?.time ?? null);
  const marked = useLatest(moment);

  const on = JSON.stringify(timeWindows(element.values));
  const windows = useLatest(JSON.parse(on) as [number, number][]);

  const lives = useRef<Live[]>([]);
  const data = useRef<uPlot.AlignedData>([[]]);
  const span = useRef<[number, number]>([0, 1]);
  const calm = useRef(new CalmRange(ROOM));
  const wishes = useMemo<Wish[]>(() => traces.map((trace) => ({ type: "trace", ...trace })), [traces]);

  const draw = () => {
    const histories = lives.current.map((live) => live.history);
    const ends = histories.flatMap(({ times }) =>
      times.length > 0 ? [[times[0], times[times.length - 1]] as [number, number]] : [],
    );
    if (ends.length === 0 || histories.length !== traces.length) {
      return;
    }
    const [first, last] = [Math.min(...ends.map((end) => end[0])), Math.max(...ends.map((end) => end[1]))];
    span.current = timeRange(
      first,
      last,
      // a record shorter than the window has no more to come
      isRecord() && settings.window !== null && last - first < settings.window ? null : settings.window,
      moment,
    );
    data.current = sideBySide(histories, span.current[0]) as uPlot.AlignedData;
    chart.current?.setData(data.current);
  };
  // Samples are gathered while the panel is hidden; only the drawing waits.
  const streaming = useStreams(wishes, true, (newest) => {
    lives.current = newest;
    if (visible) {
      draw();
    }
  });
  useEffect(draw, [visible, settings.window, moment]);

  const options = (look: Look): ChartOptions => ({
    ...frame(look),
    scales: {
      x: { time: false, range: () => span.current },
      y: {
        range: (_, low, high) => {
          const extent = Number.isFinite(low) && Number.isFinite(high) ? ([low, high] as const) : null;
          return [...(settings.range ?? calm.current.next(extent, [], performance.now()))];
        },
      },
    },
    axes: [
      axis(look, { scale: "x", side: 2, label: timeUnit === "" ? "time" : `time (${timeUnit})` }),
      axis(look, { scale: "y", side: 3 }),
    ],
    series: [
      {},
      ...labels.map((label, i) => ({
        label,
        scale: "y",
        stroke: curveColor(i, look.shade),
        width: 1.5 * look.unit,
        points: { show: false },
        spanGaps: true,
      })),
    ],
    hooks: {
      draw: [
        (self) => drawWindows(self, windows.current, look),
        (self) => drawMoment(self, marked.current, look),
      ],
    },
  });
  const { host, chart } = useChart(
    {
      options,
      data: () => (data.current.length === labels.length + 1 ? data.current : [[], ...labels.map(() => [])]),
      label: `${labels.join(", ")} over time`,
      along: { x: "time" },
      read: (self) => readAt(self, labels),
    },
    JSON.stringify([labels, timeUnit, settings.range]),
  );
  useEffect(() => chart.current?.redraw(false), [chart, on]);
  const remove = (at: number) => set({ traces: traces.filter((_, i) => i !== at) });

  return (
    <PlotFrame
      {...props}
      kind="course"
      streaming={streaming}
      legend={labels.map((label, i) => (
        <span key={label} className="plot-chip plot-still" title={label}>
          <span className="plot-swatch" style={{ borderColor: curveColor(i, scheme) }} />
          <span className="plot-label one-line">{label}</span>
          {labels.length > 1 && (
            <CloseButton
              size={16}
              iconSize={12}
              aria-label={`Remove ${label} from this plot`}
              onClick={() => remove(i)}
            />
          )}
        </span>
      ))}
      controls={
        <CourseControls
          first={JSON.parse(own) as TraceSetting}
          traces={traces}
          settings={settings}
          shown={() => rangeOf(chart.current)}
          set={set}
        />
      }
      table={() => ({
        header: [timeUnit === "" ? "time" : `time (${timeUnit})`, ...labels],
        columns: data.current,
      })}
      exportAs={(format) => {
        if (chart.current !== null) {
          const { width, height } = chart.current;
          const legend = (look: Look) =>
            labels.map((label, i) => ({ label, color: curveColor(i, look.shade) }));
          void exportDrawing(
            {
              title: `${element.path} over time`,
              width,
              height,
              options,
              data: data.current,
              legend,
            },
            format,
          );
        }
      }}
    >
      <div
        ref={host}
        className="plot-host"
        tabIndex={0}
        role="group"
        aria-label={`Drawing of ${element.path} over time`}
      />
    </PlotFrame>
  );
}

function rangeOf(chart: uPlot | null): [number, number] {
  const { min, max } = chart?.scales["y"] ?? {};
  return [min ?? 0, max ?? 1];
}

function readAt(chart: uPlot, labels: string[]): string {
  const index = chart.cursor.idx;
  const time = index == null ? undefined : chart.data[0][index];
  if (index == null || time === undefined) {
    return "";
  }
  const values = labels.flatMap((label, i) => {
    const value = chart.data[i + 1]?.[index];
    return value == null ? [] : [labels.length > 1 ? `${label} ${reading(value)}` : reading(value)];
  });
  return [`t ${reading(time)}`, ...values].join("   ");
}
