// An array over two axes as colours, with a colour bar.

import { useRef } from "react";
import type uPlot from "uplot";
import type { AxisView } from "../../protocol";
import { useStudio } from "../../store";
import type { Live, Wish } from "../../streams";
import { drawColorBar } from "../colors/colorBar";
import { AxisControl } from "../controls/AxisControl";
import { ColorsControl } from "../controls/ColorsControl";
import { arrayTable } from "../export/exportCsv";
import { exportDrawing } from "../export/exportDrawing";
import { attachInjection } from "../injection/injection";
import type { ScaleName } from "../colors/colors";
import { axisLabel, commonScale, edges } from "../../model/axes";
import { type PlotKind, runsDown } from "../../model/ports";
import { pushAmplitude } from "../chart/levels";
import { axis, type Look, mapFrame } from "../colors/look";
import { FollowingColors, middleOf } from "../colors/mapColors";
import { paintHeat } from "../colors/paint";
import { PlotFrame, type PlotProps } from "../PlotFrame";
import { PushControl } from "../controls/PushControl";
import { readPlane } from "../readPlane";
import { allAxes } from "../section";
import { SectionStrip } from "../controls/SectionStrip";
import type { Injection } from "../spot";
import { type ChartOptions, useChart } from "../chart/useChart";
import { useLatest } from "../useLatest";
import { useLevels } from "../chart/useLevels";
import { useStreams } from "../useStreams";

const UNKNOWN: AxisView = { key: "", name: "", lower: 0, upper: 1, samples: 2, periodic: false, unit: "" };

export type PlaneMapProps = PlotProps & {
  kind: PlotKind;
  // What the values are: a port, or a parameter.
  shown: string;
  wish: Wish;
  ports?: string[];
  note?: string;
  colours: { name: ScaleName; twoSided: boolean };
  // Whether the pointer injects an input.
  injects: boolean;
};

export function PlaneMap(props: PlaneMapProps) {
  const { element, settings, visible, set, shown, wish, colours, injects } = props;
  const { at } = settings;
  const { name, twoSided } = colours;

  const heat = useRef<HTMLCanvasElement | null>(null);
  const newest = useRef<Live | null>(null);
  const colors = useRef(new FollowingColors(name));
  const levels = useLevels(element.id, shown, () => paint());
  const streaming = useStreams([wish], visible, ([live]) => {
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
    return injects && document !== null && form !== null
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
      label: `${shown} of ${element.path} as colours over ${x.name} and ${y.name}`,
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
    JSON.stringify([element.id, shown, x, y, down, settings.range, name]),
  );

  return (
    <PlotFrame
      {...props}
      streaming={streaming}
      strip={<SectionStrip rest={form?.rest ?? []} at={at} set={set} />}
      controls={
        <>
          <AxisControl axes={allAxes(form)} labels={["To the right", "Upwards"]} set={set} />
          <ColorsControl settings={settings} shown={() => colors.current.now.range} set={set} />
          {injects && (
            <PushControl
              amplitude={settings.amplitude ?? pushAmplitude(levels.current)}
              width={settings.width}
              set={set}
            />
          )}
        </>
      }
      table={() => {
        const { frame, form: now } = newest.current ?? {};
        return frame == null || now == null ? null : arrayTable(now, frame.values, shown);
      }}
      exportAs={(format) => {
        if (chart.current !== null && heat.current !== null) {
          const { width, height } = chart.current;
          void exportDrawing(
            {
              title: `${element.path} ${shown}`,
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
        aria-label={`Drawing of ${element.path}${injects ? "; hold I to inject" : ""}`}
      />
    </PlotFrame>
  );
}
