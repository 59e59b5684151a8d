// An array along one of its axes as colours over time: time to the right or down, the newest samples or those
// around a moment of the past.

import { SegmentedControl } from "@mantine/core";
import { useEffect, useMemo, useRef } from "react";
import type uPlot from "uplot";
import type { AxisView } from "../../protocol";
import { isRecord } from "../../replay/replay";
import { Rows } from "../../rows";
import { useStudio } from "../../store";
import type { Wish } from "../../streams";
import { drawColorBar } from "../colors/colorBar";
import { AxisControl } from "../controls/AxisControl";
import { ColorsControl } from "../controls/ColorsControl";
import { axisHeader, plane } from "../export/exportCsv";
import { exportDrawing } from "../export/exportDrawing";
import { axisLabel, cell, edges, points } from "../../model/axes";
import { isPicture } from "../../model/ports";
import { axis, type Look, mapFrame } from "../colors/look";
import { FollowingColors, middleOf, scaleOf } from "../colors/mapColors";
import { drawMoment } from "../chart/momentLine";
import { extent, paintHeat } from "../colors/paint";
import { PlotFrame, type PlotProps } from "../PlotFrame";
import { reading } from "../range";
import { allAxes } from "../section";
import { SectionStrip } from "../controls/SectionStrip";
import { timeRange } from "../traces";
import { type ChartOptions, useChart } from "../chart/useChart";
import { useLatest } from "../useLatest";
import { useLevels } from "../chart/useLevels";
import { usePorts } from "../usePorts";
import { useStreams } from "../useStreams";
import { WindowControl } from "../controls/WindowControl";

const MOST = 128;
const MOST_COLUMNS = 800;
const UNKNOWN: AxisView = { key: "", name: "", lower: 0, upper: 1, samples: 2, periodic: false, unit: "" };

export function SpaceTime(props: PlotProps) {
  const { element, port, settings, visible, set } = props;
  const { down, drawn, at } = settings;
  const kind = useStudio((state) => state.kinds.get(element.kind));
  const timeUnit = useStudio((state) => state.document?.time_unit ?? "");
  const ports = usePorts(element, port, (axes) => axes.length > 0 && !isPicture(axes));
  const { name, twoSided } = scaleOf(settings.scale, kind, port);
  // A line marks the moment of the past that the page shows.
  const moment = useStudio((state) => state.clock?.timeline?.time ?? null);
  const marked = useLatest(moment);

  const map = useRef<HTMLCanvasElement | null>(null);
  const rows = useRef(new Rows());
  const span = useRef<[number, number]>([0, settings.window ?? 1]);
  const colors = useRef(new FollowingColors(name));
  const levels = useLevels(element.id, port, () => draw());
  const wishes = useMemo<Wish[]>(
    () => [{ type: "rows", element: element.id, port, most: MOST, drawn: drawn[0] ?? "", at }],
    [element.id, port, drawn, at],
  );
  const draw = () => {
    const { times, width } = rows.current;
    const [first, last] = [times[0], times[times.length - 1]];
    if (map.current === null || chart.current === null || first === undefined || last === undefined) {
      return;
    }
    span.current = timeRange(
      first,
      last,
      // a record shorter than the window has no more to come
      isRecord() && settings.window !== null && last - first < settings.window ? null : settings.window,
      moment,
    );
    const { clientWidth, clientHeight } = chart.current.over;
    const columns = Math.max(1, Math.min(MOST_COLUMNS, down ? clientHeight : clientWidth));
    const values = rows.current.spread(span.current, columns);
    colors.current.follow(values, name, middleOf(twoSided, levels.current), settings.range);
    const { range, table } = colors.current.now;
    if (down) {
      paintHeat(map.current, turned(values, columns, width), width, columns, range, table, true);
    } else {
      paintHeat(map.current, values, columns, width, range, table);
    }
    chart.current.setData(data());
    reread();
  };
  // Rows are gathered while the panel is hidden; only the drawing waits.
  const streaming = useStreams(wishes, true, ([live]) => {
    rows.current = live?.rows ?? new Rows();
    if (visible) {
      draw();
    }
  });
  const form = streaming.forms[0] ?? null;
  const [x = UNKNOWN] = form?.axes ?? [];
  useEffect(draw, [visible, settings.window, settings.range, moment, name]);

  const data = (): uPlot.AlignedData => (down ? [edges(x), span.current] : [span.current, edges(x)]);
  const options = (look: Look): ChartOptions => {
    const time = timeUnit === "" ? "time" : `time (${timeUnit})`;
    const [across, up] = down ? [axisLabel(x), time] : [time, axisLabel(x)];
    return {
      ...mapFrame(look),
      scales: {
        x: { time: false, range: () => (down ? edges(x) : span.current) },
        y: { range: () => (down ? span.current : edges(x)), dir: down ? -1 : 1 },
      },
      axes: [
        axis(look, { scale: "x", side: 2, label: across, grid: false }),
        axis(look, { scale: "y", side: 3, label: up, grid: false }),
      ],
      hooks: {
        draw: [
          (self) => {
            drawMoment(self, marked.current, look, down);
            drawColorBar(self, look, colors.current.now);
          },
        ],
      },
    };
  };
  const redraw = useLatest(draw);
  const { host, chart, reread } = useChart(
    {
      options,
      data,
      label: `${port} of ${element.path} as colours over time and ${x.name}`,
      along: down ? { x, y: "time" } : { x: "time", y: x },
      read: (_, at) => {
        const [time, place] = down ? [at.y, at.x] : [at.x, at.y];
        return readAt(rows.current, x, place, time, marked.current);
      },
      attach: (self) => {
        const canvas = document.createElement("canvas");
        canvas.className = "plot-heat";
        self.under.append(canvas);
        map.current = canvas;
        // The chart is known after this call.
        queueMicrotask(() => redraw.current());
        return () => {
          map.current = null;
        };
      },
    },
    JSON.stringify([element.id, port, x, down, timeUnit]),
  );

  return (
    <PlotFrame
      {...props}
      kind="space_time"
      ports={ports}
      streaming={streaming}
      strip={<SectionStrip rest={form?.rest ?? []} at={at} set={set} />}
      controls={
        <>
          <AxisControl axes={allAxes(form)} labels={["Axis over time"]} set={set} />
          <WindowControl window={settings.window} set={(window) => set({ window })} />
          <SegmentedControl
            size="xs"
            fullWidth
            aria-label="Direction of time"
            data={[
              { value: "right", label: "time to the right" },
              { value: "down", label: "time down" },
            ]}
            value={down ? "down" : "right"}
            onChange={(value) => set({ down: value === "down" })}
          />
          <ColorsControl settings={settings} shown={() => colors.current.now.range} set={set} />
        </>
      }
      table={() => {
        const { times, values } = rows.current.within(span.current);
        const time = timeUnit === "" ? "time" : `time (${timeUnit})`;
        return {
          header: [time, axisHeader(x, rows.current.width), port],
          columns: plane(times, points(x, rows.current.width), values),
        };
      }}
      exportAs={(format) => {
        if (chart.current !== null && map.current !== null) {
          const { width, height } = chart.current;
          void exportDrawing(
            {
              title: `${element.path} ${port} over time`,
              width,
              height,
              options,
              data: data(),
              image: map.current,
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

// The values with the two axes exchanged.
function turned(values: Float32Array, columns: number, width: number): Float32Array {
  const out = new Float32Array(values.length);
  for (let i = 0; i < columns; i++) {
    for (let j = 0; j < width; j++) {
      out[j * columns + i] = values[i * width + j] as number;
    }
  }
  return out;
}

// Where only the position is known, the value at the moment that is shown; where only the time is known, the
// maximum.
function readAt(
  rows: Rows,
  x: AxisView,
  place: number | null,
  time: number | null,
  moment: number | null,
): string {
  const words = [
    ...(time === null ? [] : [`t ${reading(time)}`]),
    ...(place === null ? [] : [`${x.name} ${reading(place)}`]),
  ];
  const values = rows.at(time ?? moment ?? Infinity)?.values;
  const value = place === null ? extent(values ?? [])?.[1] : values?.[cell(x, rows.width, place)];
  const shown = value === undefined ? [] : [place === null ? `max ${reading(value)}` : reading(value)];
  return [...words, ...shown].join("   ");
}
