// A plot of the page: the streams that its kind asks for, and the drawings of what the kind makes of them.

import { CloseButton, UnstyledButton, useComputedColorScheme } from "@mantine/core";
import { useEffect, useMemo, useRef } from "react";
import type { Axis } from "../draw/axis";
import type { Content } from "../draw/content";
import type { Shade } from "../draw/ink";
import { tableOf } from "../draw/table";
import type { PlotKind } from "../model/ports";
import { openPlot } from "../actions/openPlot";
import { useStudio } from "../server/store";
import type { Live } from "../server/streams";
import { PlotSettingsControls } from "./controls/PlotSettingsControls";
import { SectionStrip } from "./controls/SectionStrip";
import type { Drawing } from "./Drawing";
import { type DrawingFormat, exportDrawing, exportMultiples } from "./export/exportDrawing";
import { DrawingPlace } from "./DrawingPlace";
import type { FlatPlot, LegendEntry, Shown } from "./kinds/kind";
import { levelsAt } from "./kinds/parts";
import { pushAmplitude } from "../model/levels";
import { Memory } from "./kinds/memory";
import { PlotFrame, type PlotProps } from "./PlotFrame";
import { curveLevel } from "../model/shownPorts";
import type { Injection } from "./injection/spot";
import { usePorts } from "../widgets/usePorts";
import { useStreams } from "./useStreams";

type TileProps = PlotProps & { kind: PlotKind; plot: FlatPlot };

export function Tile(props: TileProps) {
  const { element, port, settings } = props;
  const document = useStudio((state) => state.document);
  const elements = useStudio((state) => state.elements);
  const type = useStudio((state) => state.kinds.get(element.kind));
  const moment = useStudio((state) => state.clock?.timeline?.time ?? null);
  return document === null ? null : (
    <ShownTile {...props} shown={{ document, elements, type, element, port, settings, moment }} />
  );
}

function ShownTile(props: TileProps & { shown: Shown }) {
  const { element, port, settings, visible, set, plot, shown } = props;
  const { at, drawn, traces, across, up } = settings;
  const scheme = useComputedColorScheme("light", { getInitialValueInEffect: false });
  const ports = usePorts(element, port, plot.ports ?? (() => false));
  const calm = JSON.stringify([element.id, port, drawn, traces, across, up]);
  // The values of another port have no part in the ranges of this one.
  const [memory, lives] = useMemo(
    (): [Memory, { current: Live[] }] => [new Memory(), { current: [] }],
    [calm],
  );
  // By the element of each cell; a plot without cells has one of its own element.
  const drawings = useRef(new Map<string, Drawing>());
  const cells = "cells" in plot ? plot.cells(shown) : null;
  const ids = cells?.map(({ id }) => id) ?? [element.id];
  const contents = (): (Content | null)[] =>
    "contents" in plot
      ? plot.contents(shown, lives.current, memory)
      : [plot.content(shown, lives.current, memory)];
  const draw = () => {
    if (visible) {
      contents().forEach((content, i) => drawings.current.get(ids[i] ?? "")?.show(content));
    }
  };
  const wishes = plot.wishes(shown);
  // Samples over time are gathered while the plot is hidden; only the drawing waits.
  const gathers = wishes.some(({ type }) => type === "trace" || type === "rows");
  const streaming = useStreams(wishes, visible || gathers, (newest) => {
    lives.current = newest;
    draw();
  });
  useEffect(draw);

  const form = streaming.forms.find((other) => other !== null) ?? null;
  const controls = plot.settings(shown);
  const pushes = controls.includes("push") && element.pushable;
  const amplitude =
    settings.amplitude ?? pushAmplitude(levelsAt(shown, curveLevel(element, shown.type, port)));
  const injection = ({ x, y }: Content): Injection => ({
    element,
    document: shown.document,
    shown: [x.along, y.along].filter((along): along is Axis => along !== null && along !== "time"),
    amplitude,
    width: settings.width,
    at,
  });
  const legend = plot.legend?.(shown) ?? [];
  const table = () => {
    const drawn = ids.flatMap((id, i) => {
      const content = drawings.current.get(id)?.content ?? null;
      return content === null ? [] : [{ content, name: cells?.[i]?.path ?? "" }];
    });
    const names = cells === null ? undefined : drawn.map(({ name }) => name);
    return tableOf(
      drawn.map(({ content }) => content),
      names,
    );
  };
  const exportAs = (format: DrawingFormat) => {
    const drawing = drawings.current.get(element.id);
    if (cells !== null) {
      const drawn = cells.flatMap(({ id, path }) => {
        const { host, content = null } = drawings.current.get(id) ?? {};
        return host === undefined ? [] : [{ name: path, box: host.getBoundingClientRect(), content }];
      });
      exportMultiples(plot.file(shown), drawn, format);
    } else if (drawing?.content != null) {
      const { clientWidth: width, clientHeight: height } = drawing.host;
      const entries = legend.filter(({ on, dashed }) => on && dashed !== true);
      exportDrawing(plot.file(shown), { width, height, content: drawing.content }, entries, format);
    }
  };
  const keep = (id: string) => (drawing: Drawing | null) => {
    if (drawing === null) {
      drawings.current.delete(id);
    } else {
      drawings.current.set(id, drawing);
    }
  };
  return (
    <PlotFrame
      {...props}
      {...(plot.ports === undefined ? {} : { ports })}
      streaming={streaming}
      note={plot.note?.(shown) ?? ""}
      legend={legend.map((entry) => (
        <LegendChip key={entry.label} entry={entry} shade={scheme} set={set} />
      ))}
      strip={<SectionStrip rest={form?.rest ?? []} at={at} set={set} />}
      {...(controls.length === 0
        ? {}
        : {
            controls: (
              <PlotSettingsControls
                names={controls}
                sides={plot.sides ?? []}
                shown={shown}
                form={form}
                range={() => memory.range}
                amplitude={amplitude}
                set={set}
              />
            ),
          })}
      table={table}
      exportAs={exportAs}
    >
      {cells === null ? (
        <DrawingPlace
          label={plot.label(shown)}
          name={`Drawing of ${element.path}${pushes ? "; hold I to inject" : ""}`}
          injection={pushes ? injection : null}
          keep={keep(element.id)}
        />
      ) : (
        <div className="plot-multiples" role="group" aria-label={plot.label(shown)}>
          {cells.map((other) => (
            <div key={other.id} className="plot-cell">
              <UnstyledButton
                className="plot-cell-name one-line"
                title={`Plot ${other.path}`}
                onClick={() => openPlot({ element: other.id, port })}
              >
                {other.path}
              </UnstyledButton>
              <div className="plot-cell-body">
                <DrawingPlace label={`${port} of ${other.path}`} injection={null} keep={keep(other.id)} />
              </div>
            </div>
          ))}
        </div>
      )}
    </PlotFrame>
  );
}

type LegendChipProps = { entry: LegendEntry; shade: Shade; set: PlotProps["set"] };

// An entry that is pressed shows and hides its curve.
function LegendChip({ entry, shade, set }: LegendChipProps) {
  const { label, color, dashed = false, on, press, remove } = entry;
  const swatch = (
    <span className="plot-swatch" data-dashed={dashed || undefined} style={{ borderColor: color[shade] }} />
  );
  if (press !== undefined) {
    return (
      <UnstyledButton className="plot-chip" aria-pressed={on} onClick={() => set(press)}>
        {swatch}
        {label}
      </UnstyledButton>
    );
  }
  return (
    <span className="plot-chip plot-still" title={label}>
      {swatch}
      <span className="plot-label one-line">{label}</span>
      {remove !== undefined && (
        <CloseButton
          size={16}
          iconSize={12}
          aria-label={`Remove ${label} from this plot`}
          onClick={() => set(remove)}
        />
      )}
    </span>
  );
}
