// An array along one axis: activation, output, input and interaction as curves, levels as lines.

import { useComputedColorScheme } from "@mantine/core";
import { useMemo, useRef } from "react";
import type uPlot from "uplot";
import type { AxisView } from "../../protocol";
import { useStudio } from "../../store";
import type { Live, Wish } from "../../streams";
import { AxisControl } from "../controls/AxisControl";
import { Chip } from "../controls/Chip";
import { inOrder, portColor } from "../colors/colors";
import { axisHeader } from "../export/exportCsv";
import { exportDrawing } from "../export/exportDrawing";
import { attachInjection } from "../injection/injection";
import { axisLabel, points } from "../../model/axes";
import { portAxes, portsAlike } from "../../model/ports";
import { type Level, pushAmplitude } from "../chart/levels";
import { drawLevels } from "../chart/levelLines";
import { axis, frame, type Look } from "../colors/look";
import { PlotFrame, type PlotProps } from "../PlotFrame";
import { PushControl } from "../controls/PushControl";
import { CalmRange, reading, union } from "../range";
import { RangeControl } from "../controls/RangeControl";
import { allAxes } from "../section";
import { SectionStrip } from "../controls/SectionStrip";
import { curveLevel, firstCurves, LEVELS } from "../shownPorts";
import type { Injection } from "../spot";
import { type ChartOptions, useChart } from "../chart/useChart";
import { useLatest } from "../useLatest";
import { useLevels } from "../chart/useLevels";
import { useStreams } from "../useStreams";

const MOST = 600;
const ROOM = 0.03;

export function FieldCurve(props: PlotProps) {
  const { element, port, settings, visible, set } = props;
  const scheme = useComputedColorScheme("light", { getInitialValueInEffect: false });
  const kind = useStudio((state) => state.kinds.get(element.kind));
  const ports = inOrder(portsAlike(element, port));
  const level = curveLevel(element, kind, port);
  const names = Object.keys(kind?.levels[level] ?? {});
  const recorded = useStudio((state) => state.document?.record?.ports[element.id]);
  const shown = settings.shown ?? firstCurves(ports, level, recorded);
  const curves = ports.filter((other) => shown.includes(other));
  const withLevels = names.length > 0 && shown.includes(LEVELS);

  const { drawn, at } = settings;
  const first = useStudio(({ document }) =>
    document === null ? "" : (portAxes(document, element, port)?.[0]?.name ?? ""),
  );

  const calm = useRef(new CalmRange(ROOM));
  const data = useRef<uPlot.AlignedData>([[]]);
  const levels = useLevels(element.id, level, () => chart.current?.setData(data.current));
  const wishes = useMemo<Wish[]>(
    () =>
      curves.map((other) => ({
        type: "watch",
        element: element.id,
        port: other,
        most: MOST,
        // a curve has one axis, also of an array with more
        drawn: [drawn[0] ?? first],
        at,
      })),
    [element.id, curves.join(), drawn, at, first],
  );
  const draw = (lives: Live[]) => {
    data.current = columns(lives);
    chart.current?.setData(data.current);
  };
  const streaming = useStreams(wishes, visible, draw);
  const form = streaming.forms.find((other) => other !== null) ?? null;
  const x = form?.axes[0] ?? documentAxis(element.id, port, drawn[0]);
  const onRight = (other: string) =>
    names.length > 0 && other === "output" && other !== level && curves.some((curve) => curve !== other);

  const lines = (): Level[] => (withLevels ? levels.current : []);
  const options = (look: Look): ChartOptions => ({
    ...frame(look),
    scales: {
      x: { time: false, range: () => bounds(x) },
      left: {
        range: (_, low, high) => {
          const extent = Number.isFinite(low) && Number.isFinite(high) ? ([low, high] as const) : null;
          return [
            ...(settings.range ??
              calm.current.next(
                extent,
                lines().map((line) => line.value),
                performance.now(),
              )),
          ];
        },
      },
      right: { range: (_, low, high) => rightRange(low, high) },
    },
    axes: [
      axis(look, { scale: "x", side: 2, ...(x === null ? {} : { label: axisLabel(x) }) }),
      axis(look, { scale: "left", side: 3 }),
      ...(curves.some(onRight) && !look.small
        ? [axis(look, { scale: "right", side: 1, label: "output", grid: false })]
        : []),
    ],
    series: [
      {},
      ...curves.map((other) => ({
        label: other,
        scale: onRight(other) ? "right" : "left",
        stroke: portColor(other, ports, look.shade),
        width: (other === level ? 2 : 1.5) * look.unit,
        points: { show: false },
      })),
    ],
    hooks: { draw: [(self) => drawLevels(self, lines(), look)] },
  });
  // What is drawn of the axis, not the axis: a new chart at the first values would end what a
  // hand holds.
  const key = JSON.stringify([
    element.id,
    curves,
    withLevels,
    settings.range,
    x && [x.name, x.unit, x.lower, x.upper],
  ]);
  const injection = (): Injection | null => {
    const { document } = useStudio.getState();
    return element.pushable && document !== null && x !== null
      ? {
          element,
          document,
          shown: [x],
          amplitude: settings.amplitude ?? pushAmplitude(levels.current),
          width: settings.width,
          at,
        }
      : null;
  };
  const latest = useLatest(injection);
  const { host, chart } = useChart(
    {
      options,
      data: () => (data.current.length === curves.length + 1 ? data.current : [[], ...curves.map(() => [])]),
      label: `${curves.join(", ")} of ${element.path} over ${x?.name ?? "its axis"}`,
      along: { x },
      read: (self) => readAt(self, x, curves),
      attach: (self, look) =>
        attachInjection(
          self,
          self.root.parentElement ?? self.root,
          () => latest.current(),
          portColor("input", ports, look.shade),
        ),
    },
    key,
  );

  const toggle = (name: string) =>
    set({ shown: shown.includes(name) ? shown.filter((other) => other !== name) : [...shown, name] });
  return (
    <PlotFrame
      {...props}
      kind="curve"
      streaming={streaming}
      legend={
        <>
          {ports.map((other) => (
            <Chip
              key={other}
              label={other}
              color={portColor(other, ports, scheme)}
              on={shown.includes(other)}
              toggle={() => toggle(other)}
            />
          ))}
          {names.length > 0 && (
            <Chip label={LEVELS} color="var(--level)" dashed on={withLevels} toggle={() => toggle(LEVELS)} />
          )}
        </>
      }
      strip={<SectionStrip rest={form?.rest ?? []} at={at} set={set} />}
      controls={
        <>
          <AxisControl axes={allAxes(form)} labels={["Axis"]} set={set} />
          <RangeControl
            range={settings.range}
            shown={() => rangeOf(chart.current)}
            set={(range) => set({ range })}
          />
          {element.pushable && (
            <PushControl
              amplitude={settings.amplitude ?? pushAmplitude(levels.current)}
              width={settings.width}
              set={set}
            />
          )}
        </>
      }
      table={() => ({
        header: [x === null ? "" : axisHeader(x, form?.shape[0]), ...curves],
        columns: data.current,
      })}
      exportAs={(format) => {
        if (chart.current !== null) {
          const { width, height } = chart.current;
          const legend = (look: Look) =>
            curves.map((other) => ({ label: other, color: portColor(other, ports, look.shade) }));
          void exportDrawing(
            { title: element.path, width, height, options, data: data.current, legend },
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
        aria-label={`Drawing of ${element.path}${element.pushable ? "; hold I to inject" : ""}`}
      />
    </PlotFrame>
  );
}

function columns(lives: Live[]): uPlot.AlignedData {
  const form = lives.find((live) => live.form !== null)?.form;
  const axis = form?.axes[0];
  const places = axis === undefined ? new Float64Array() : points(axis, form?.shape[0]);
  const nothing = () => Array.from(places, () => null);
  return [
    places,
    ...lives.map(({ frame: newest }) =>
      newest?.values.length === places.length ? newest.values : nothing(),
    ),
  ];
}

// 0 to 1 with a little room for the line, unless values lie outside.
function rightRange(low: number | null, high: number | null): [number, number] {
  const [lower, upper] = union([finite(low, 0), finite(high, 1)], [0, 1]);
  const room = ROOM * (upper - lower);
  return [lower - room, upper + room];
}

function finite(value: number | null, otherwise: number): number {
  return value !== null && Number.isFinite(value) ? value : otherwise;
}

function bounds(x: AxisView | null): [number, number] {
  return x === null ? [0, 1] : [x.lower, x.upper];
}

function rangeOf(chart: uPlot | null): [number, number] {
  const { min, max } = chart?.scales["left"] ?? {};
  return [min ?? 0, max ?? 1];
}

function readAt(chart: uPlot, x: AxisView | null, curves: string[]): string {
  const index = chart.cursor.idx;
  const place = index == null ? undefined : chart.data[0][index];
  if (index == null || place === undefined || x === null) {
    return "";
  }
  const values = curves.flatMap((curve, i) => {
    const value = chart.data[i + 1]?.[index];
    return value == null ? [] : [`${curve} ${reading(value)}`];
  });
  return [`${x.name} ${reading(place)}`, ...values].join("   ");
}

function documentAxis(element: string, port: string, drawn = ""): AxisView | null {
  const { document, elements } = useStudio.getState();
  const found = elements.get(element);
  const axes = document === null || found === undefined ? null : portAxes(document, found, port);
  return axes?.find(({ name }) => name === drawn) ?? axes?.[0] ?? null;
}
