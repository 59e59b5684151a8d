// A phase plot: a time course against its rate of change, or against another time course. The newest sample,
// or the moment of the past that the page shows, is a dot; the tail behind it fades.

import { Checkbox, Text } from "@mantine/core";
import { useEffect, useMemo, useRef } from "react";
import type uPlot from "uplot";
import { useStudio } from "../../store";
import type { Live, Wish } from "../../streams";
import { curveColor } from "../colors/colors";
import { exportDrawing } from "../export/exportDrawing";
import { portAxes } from "../../model/ports";
import { axis, frame, type Look } from "../colors/look";
import { extent } from "../colors/paint";
import { PlotFrame, type PlotProps } from "../PlotFrame";
import { CalmRange, reading } from "../range";
import type { TraceSetting } from "../settings";
import { drawTail } from "../chart/tail";
import { TraceControl, traceOf } from "../controls/TraceControl";
import { traceLabel } from "../traces";
import { nearestPlace, nearestTime, NO_TRAJECTORY, trajectory } from "./trajectory";
import { type ChartOptions, useChart } from "../chart/useChart";
import { useLatest } from "../useLatest";
import { useStreams } from "../useStreams";
import { WindowControl } from "../controls/WindowControl";

const ROOM = 0.05;

export function Phase(props: PlotProps) {
  const { element, port, settings, visible, set } = props;
  const timeUnit = useStudio((state) => state.document?.time_unit ?? "");
  const own = useStudio(({ document }) =>
    JSON.stringify(traceOf(element.id, port, (document && portAxes(document, element, port)) || [], "max")),
  );
  const kept = JSON.stringify([settings.across ?? JSON.parse(own), settings.up]);
  const [across, up] = useMemo(() => JSON.parse(kept) as [TraceSetting, TraceSetting | null], [kept]);
  const moment = useStudio((state) => state.clock?.timeline?.time ?? null);
  const label = useStudio(({ elements }) => {
    const path = (id: string) => (id === element.id ? "" : (elements.get(id)?.path ?? "gone"));
    return [across, ...(up === null ? [] : [up])]
      .map((trace) => traceLabel(trace, path(trace.element)))
      .join("\n");
  });
  const rate = `rate of change${timeUnit === "" ? "" : ` (1/${timeUnit})`}`;
  const [acrossLabel = "", upLabel = rate] = label.split("\n");
  const labels = [acrossLabel, upLabel] as const;

  const lives = useRef<Live[]>([]);
  const shown = useRef(NO_TRAJECTORY);
  const calm = useMemo(() => [new CalmRange(ROOM), new CalmRange(ROOM)] as const, [kept]);
  const ranges = useRef<[[number, number], [number, number]]>([
    [0, 1],
    [0, 1],
  ]);
  const wishes = useMemo<Wish[]>(
    () => [across, ...(up === null ? [] : [up])].map((trace) => ({ type: "trace", ...trace })),
    [across, up],
  );

  const draw = () => {
    const [one, other] = lives.current;
    const times = one?.history.times ?? [];
    const newest = times[times.length - 1];
    if (one === undefined || newest === undefined || (up !== null && other === undefined)) {
      return;
    }
    const end = moment ?? newest;
    const start = settings.window === null ? -Infinity : end - settings.window;
    shown.current = trajectory(one.history, up === null ? null : (other?.history ?? null), [start, end]);
    const now = performance.now();
    ranges.current = [
      [...calm[0].next(extent(shown.current.across), [], now)],
      [...calm[1].next(extent(shown.current.up), up === null ? [0] : [], now)],
    ];
    chart.current?.setData(data());
    reread();
  };
  // Samples are gathered while the panel is hidden; only the drawing waits.
  const streaming = useStreams(wishes, true, (newest) => {
    lives.current = newest;
    if (visible) {
      draw();
    }
  });
  useEffect(draw, [visible, settings.window, moment]);

  const data = (): uPlot.AlignedData => [...ranges.current];
  const options = (look: Look): ChartOptions => {
    const base = frame(look);
    return {
      ...base,
      cursor: { ...base.cursor, y: true, points: { show: false } },
      scales: {
        x: { time: false, range: () => ranges.current[0] },
        y: { range: () => ranges.current[1] },
      },
      axes: [
        axis(look, { scale: "x", side: 2, label: labels[0] }),
        axis(look, { scale: "y", side: 3, label: labels[1] }),
      ],
      series: [{}, { scale: "y", paths: () => null, points: { show: false } }],
      hooks: {
        draw: [
          (self) => drawTail(self, shown.current, up === null ? 0 : null, curveColor(0, look.shade), look),
        ],
      },
    };
  };
  const redraw = useLatest(draw);
  const { host, chart, reread } = useChart(
    {
      options,
      data,
      orbit: {
        at: (time) => placeOf(nearestTime(shown.current, time)),
        time: (x, y) => shown.current.times[nearest(x, y)] ?? null,
      },
      label: `${labels[1]} over ${labels[0]} of ${element.path}`,
      read: (_, at) => {
        const i = at.x === null || at.y === null ? -1 : nearest(at.x, at.y);
        const { times, across: xs, up: ys } = shown.current;
        return i < 0 ? "" : `t ${reading(times[i] ?? 0)}   ${reading(xs[i] ?? 0)}   ${reading(ys[i] ?? 0)}`;
      },
      attach: () => {
        // The chart is known after this call.
        queueMicrotask(() => redraw.current());
        return () => undefined;
      },
    },
    JSON.stringify([element.id, labels]),
  );
  const nearest = (x: number, y: number) => {
    const [[left, right], [low, high]] = ranges.current;
    return nearestPlace(shown.current, [x, y], [right - left, high - low]);
  };
  const placeOf = (i: number) => {
    const [x, y] = [shown.current.across[i], shown.current.up[i]];
    return x === undefined || y === undefined ? null : ([x, y] as const);
  };

  return (
    <PlotFrame
      {...props}
      kind="phase"
      streaming={streaming}
      controls={
        <>
          <WindowControl window={settings.window} set={(window) => set({ window })} />
          <div className="plot-more">
            <Text size="xs" fw={500}>
              To the right
            </Text>
            <TraceControl trace={across} label="the horizontal axis" set={(next) => set({ across: next })} />
          </div>
          <div className="plot-more">
            <Text size="xs" fw={500}>
              Upwards
            </Text>
            <Checkbox
              size="xs"
              label="rate of change of the other axis"
              checked={up === null}
              onChange={(event) => set({ up: event.currentTarget.checked ? null : across })}
            />
            {up !== null && (
              <TraceControl trace={up} label="the vertical axis" set={(next) => set({ up: next })} />
            )}
          </div>
        </>
      }
      table={() => ({
        header: [timeUnit === "" ? "time" : `time (${timeUnit})`, ...labels],
        columns: [shown.current.times, shown.current.across, shown.current.up],
      })}
      exportAs={(format) => {
        if (chart.current !== null) {
          const { width, height } = chart.current;
          void exportDrawing(
            { title: `${element.path} phase`, width, height, options, data: data() },
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
        aria-label={`Drawing of the phase of ${element.path}`}
      />
    </PlotFrame>
  );
}
