// An array over two axes as colours; with more axes a section at positions on the others, or the maximum over
// them.

import { useMemo, useRef } from "react";
import type uPlot from "uplot";
import type { AxisView } from "../protocol";
import { useStudio } from "../store";
import type { Live, Wish } from "../streams";
import { drawColorBar } from "./colorBar";
import { AxisControl } from "./AxisControl";
import { ColorsControl } from "./ColorsControl";
import { plane } from "./exportCsv";
import { exportDrawing } from "./exportDrawing";
import { attachInjection } from "./injection";
import { axisLabel, commonScale, edges, points, runsDown } from "./kinds";
import { pushAmplitude } from "./levels";
import { axis, type Look, mapFrame } from "./look";
import { FollowingColors, middleOf, scaleOf } from "./mapColors";
import { paintHeat } from "./paint";
import { PlotFrame, type PlotProps } from "./PlotFrame";
import { PushControl } from "./PushControl";
import { readPlane } from "./readPlane";
import { allAxes } from "./section";
import { SectionStrip } from "./SectionStrip";
import type { Injection } from "./spot";
import { type ChartOptions, useChart } from "./useChart";
import { useLatest } from "./useLatest";
import { useLevels } from "./useLevels";
import { usePorts } from "./usePorts";
import { useStreams } from "./useStreams";

const MOST = 256;
const UNKNOWN: AxisView = { key: "", name: "", lower: 0, upper: 1, samples: 2, periodic: false, unit: "" };

export function HeatMap(props: PlotProps) {
  const { element, port, settings, visible, set } = props;
  const { drawn, at } = settings;
  const kind = useStudio((state) => state.kinds.get(element.kind));
  const ports = usePorts(element, port, (axes) => axes.length > 1);
  const { name, twoSided } = scaleOf(settings.scale, kind, port);

  const heat = useRef<HTMLCanvasElement | null>(null);
  const newest = useRef<Live | null>(null);
  const colors = useRef(new FollowingColors(name));
  const levels = useLevels(element.id, port, () => paint());
  const wishes = useMemo<Wish[]>(
    () => [{ type: "watch", element: element.id, port, most: MOST, drawn, at }],
    [element.id, port, drawn, at],
  );
  const streaming = useStreams(wishes, visible, ([live]) => {
    newest.current = live ?? null;
    paint();
  });
  const form = streaming.forms[0] ?? null;
  const [x = UNKNOWN, y = UNKNOWN] = form?.axes ?? [];
  const down = useStudio((state) => state.document !== null && runsDown(state.document, y));

  const paint = () => {
    const live = newest.current;
    const [nx, ny] = live?.form?.shape ?? [];
    if (heat.current !== null && live?.frame != null && nx !== undefined && ny !== undefined) {
      const { values } = live.frame;
      // The bar is drawn again only if the colours changed.
      if (colors.current.follow(values, name, middleOf(twoSided, levels.current), settings.range)) {
        chart.current?.redraw(false, false);
      }
      const { range, table } = colors.current.now;
      paintHeat(heat.current, values, nx, ny, range, table, down);
      reread();
    }
  };
  const options = (look: Look): ChartOptions => {
    return {
      ...mapFrame(look),
      scales: { x: { time: false, range: () => edges(x) }, y: { range: () => edges(y), dir: down ? -1 : 1 } },
      axes: [
        axis(look, { scale: "x", side: 2, label: axisLabel(x), grid: false }),
        axis(look, { scale: "y", side: 3, label: axisLabel(y), grid: false }),
      ],
      hooks: {
        draw: [(self) => drawColorBar(self, look, colors.current.now)],
      },
    };
  };
  const data = (): uPlot.AlignedData => [edges(x), edges(y)];
  const injection = useLatest((): Injection | null => {
    const { document } = useStudio.getState();
    return element.pushable && document !== null && form !== null
      ? {
          element,
          document,
          shown: [x, y],
          amplitude: settings.amplitude ?? pushAmplitude(levels.current),
          width: settings.width,
          at,
        }
      : null;
  });
  const repaint = useLatest(paint);
  const { host, chart, reread } = useChart(
    {
      options,
      data,
      label: `${port} of ${element.path} as colours over ${x.name} and ${y.name}`,
      along: { x, y },
      extents: commonScale(x, y),
      read: (_, at) => readPlane(newest.current, x, y, at),
      attach: (self) => {
        const canvas = document.createElement("canvas");
        canvas.className = "plot-heat";
        self.under.append(canvas);
        heat.current = canvas;
        repaint.current();
        return attachInjection(
          self,
          self.root.parentElement ?? self.root,
          () => injection.current(),
          "#ffffff",
        );
      },
    },
    JSON.stringify([element.id, port, x, y, down, settings.range, name]),
  );

  return (
    <PlotFrame
      {...props}
      kind="heat"
      ports={ports}
      streaming={streaming}
      strip={<SectionStrip rest={form?.rest ?? []} at={at} set={set} />}
      controls={
        <>
          <AxisControl axes={allAxes(form)} labels={["To the right", "Upwards"]} set={set} />
          <ColorsControl settings={settings} shown={() => colors.current.now.range} set={set} />
          {element.pushable && (
            <PushControl
              amplitude={settings.amplitude ?? pushAmplitude(levels.current)}
              width={settings.width}
              set={set}
            />
          )}
        </>
      }
      table={() => {
        const { frame: values, form: shown } = newest.current ?? {};
        return values == null || shown == null
          ? null
          : {
              header: [axisLabel(x), axisLabel(y), port],
              columns: plane(points(x, shown.shape[0]), points(y, shown.shape[1]), values.values),
            };
      }}
      exportAs={(format) => {
        if (chart.current !== null && heat.current !== null) {
          const { width, height } = chart.current;
          void exportDrawing(
            {
              title: `${element.path} ${port}`,
              width,
              height,
              options,
              data: data(),
              image: heat.current,
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
        aria-label={`Drawing of ${element.path}${element.pushable ? "; hold I to inject" : ""}`}
      />
    </PlotFrame>
  );
}
