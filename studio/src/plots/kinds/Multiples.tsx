// Small multiples: the same port of all elements over the same axes, side by side on the same scales.

import { useEffect, useMemo, useRef } from "react";
import { openPlot } from "../../panels/openPlot";
import type { ElementView } from "../../protocol";
import { useStudio } from "../../store";
import type { Live, Wish } from "../../streams";
import { AxisControl } from "../controls/AxisControl";
import { ColorControl } from "../controls/ColorControl";
import { axisHeader, plane, type Table } from "../export/exportCsv";
import { exportMultiples } from "../export/exportDrawing";
import { elementsAlike, isPicture, portAxes } from "../../model/ports";
import { points } from "../../model/axes";
import { FollowingColors, middleOf, scaleOf } from "../colors/mapColors";
import { type CellHandle, MultipleCell, type SharedScales } from "./MultipleCell";
import { extent } from "../colors/paint";
import { PlotFrame, type PlotProps } from "../PlotFrame";
import { CalmRange } from "../range";
import { RangeControl } from "../controls/RangeControl";
import { allAxes } from "../section";
import { SectionStrip } from "../controls/SectionStrip";
import { sideBySide, timeRange } from "../traces";
import { useLevels } from "../chart/useLevels";
import { usePorts } from "../usePorts";
import { useStreams } from "../useStreams";
import { WindowControl } from "../controls/WindowControl";

const MOST_CELLS = 48;
const MOST_POINTS = 300;
const MOST_CELL_SAMPLES = 64;
const ROOM = 0.03;

export function Multiples(props: PlotProps) {
  const { element, port, settings, visible, set } = props;
  const { drawn, at, window } = settings;
  const kind = useStudio((state) => state.kinds.get(element.kind));
  const timeUnit = useStudio((state) => state.document?.time_unit ?? "");
  const ports = usePorts(element, port, (axes) => !isPicture(axes));
  const { name, twoSided } = scaleOf(settings.scale, kind, port);
  const listed = useStudio(({ document }) =>
    document === null
      ? ""
      : elementsAlike(document, element, port)
          .map(({ id, path }) => `${id} ${path}`)
          .join("\n"),
  );
  const dimensions = useStudio(({ document }) =>
    document === null ? 0 : (portAxes(document, element, port)?.length ?? 0),
  );
  const ids = useMemo(() => {
    const lines = listed.split("\n").slice(0, MOST_CELLS);
    return lines.map((line) => line.split(" ", 1)[0] ?? "");
  }, [listed]);
  const elements = useStudio.getState().elements;
  const shown = ids.flatMap((id) => elements.get(id) ?? []);
  const moment = useStudio((state) => state.clock?.timeline?.time ?? null);

  const lives = useRef<Live[]>([]);
  const handles = useRef(new Map<string, CellHandle>());
  const calm = useMemo(() => new CalmRange(ROOM), [port]);
  const scales = useRef<SharedScales>({ range: [0, 1], span: [0, 1], colors: new FollowingColors(name) });
  const levels = useLevels(element.id, port, () => draw());
  const wishes = useMemo<Wish[]>(
    () =>
      ids.map((id) =>
        dimensions === 0
          ? { type: "trace", element: id, port, reduce: "at", at: [] }
          : {
              type: "watch",
              element: id,
              port,
              most: dimensions === 1 ? MOST_POINTS : MOST_CELL_SAMPLES,
              drawn,
              at,
            },
      ),
    [ids, port, dimensions, drawn, at],
  );

  const draw = () => {
    const all = lives.current;
    const values = all.map((live) => (dimensions === 0 ? live.history.values : (live.frame?.values ?? [])));
    const ends = values.flatMap((some) => [...(extent(some) ?? [])]);
    if (ends.length === 0) {
      return;
    }
    if (dimensions > 1) {
      scales.current.colors.follow(ends, name, middleOf(twoSided, levels.current), settings.range);
    } else {
      scales.current.range = [...(settings.range ?? calm.next(extent(ends), [], performance.now()))];
    }
    const times = all.flatMap(({ history }) => [...(extent(history.times) ?? [])]);
    if (times.length > 0) {
      scales.current.span = timeRange(Math.min(...times), Math.max(...times), window, moment);
    }
    for (const handle of handles.current.values()) {
      handle.paint();
    }
  };
  // Samples of time courses are gathered while the panel is hidden; only the drawing waits.
  const streaming = useStreams(wishes, visible || dimensions === 0, (newest) => {
    lives.current = newest;
    if (visible) {
      draw();
    }
  });
  useEffect(draw, [visible, window, moment, settings.range, name]);
  const form = streaming.forms.find((other) => other !== null) ?? null;
  const axes = (index: number) => streaming.forms[index]?.axes ?? form?.axes ?? [];
  const known = dimensions === 0 || form !== null;

  return (
    <PlotFrame
      {...props}
      kind="multiples"
      ports={ports}
      streaming={streaming}
      strip={<SectionStrip rest={form?.rest ?? []} at={at} set={set} />}
      controls={
        <>
          {dimensions === 0 && <WindowControl window={window} set={(next) => set({ window: next })} />}
          {dimensions > 1 && (
            <>
              <AxisControl axes={allAxes(form)} labels={["To the right", "Upwards"]} set={set} />
              <ColorControl scale={settings.scale} set={(scale) => set({ scale })} />
            </>
          )}
          <RangeControl
            range={settings.range}
            shown={() => (dimensions > 1 ? scales.current.colors.now.range : scales.current.range)}
            set={(range) => set({ range })}
          />
        </>
      }
      table={() => tableOf(lives.current, shown, dimensions, timeUnit)}
      exportAs={(format) => {
        const cells = shown.flatMap(({ id }) => handles.current.get(id) ?? []);
        void exportMultiples(`${port} of ${shown.length} elements`, cells, format);
      }}
    >
      <div className="plot-multiples" role="group" aria-label={`${port} of elements like ${element.path}`}>
        {known &&
          shown.map((other, i) => (
            <MultipleCell
              key={other.id}
              element={other}
              port={port}
              timeLabel={timeUnit === "" ? "time" : `time (${timeUnit})`}
              axes={axes(i)}
              live={() => lives.current[i] ?? null}
              scales={scales}
              handles={handles}
              open={() => openPlot({ element: other.id, port })}
            />
          ))}
      </div>
    </PlotFrame>
  );
}

// A column of values for each element.
function tableOf(lives: Live[], shown: ElementView[], dimensions: number, timeUnit: string): Table | null {
  const names = shown.map(({ path }) => path);
  if (dimensions === 0) {
    const [times, ...columns] = sideBySide(
      lives.map(({ history }) => history),
      -Infinity,
    );
    return {
      header: [timeUnit === "" ? "time" : `time (${timeUnit})`, ...names],
      columns: [times, ...columns],
    };
  }
  const { form } = lives[0] ?? {};
  const [x, y] = form?.axes ?? [];
  if (form == null || x === undefined) {
    return null;
  }
  const values = lives.map(({ frame }) => frame?.values ?? []);
  const places = points(x, form.shape[0]);
  if (y === undefined) {
    return { header: [axisHeader(x, form.shape[0]), ...names], columns: [places, ...values] };
  }
  const [across, up] = plane(places, points(y, form.shape[1]), []);
  return {
    header: [axisHeader(x, form.shape[0]), axisHeader(y, form.shape[1]), ...names],
    columns: [across ?? [], up ?? [], ...values],
  };
}
