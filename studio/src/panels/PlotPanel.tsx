// A panel with a plot: finds its element and the component for the kind of plot.

import type { IDockviewPanelProps } from "dockview-react";
import { type ComponentType, lazy, Suspense, useEffect, useState } from "react";
import { FieldCurve } from "../plots/kinds/FieldCurve";
import { HeatMap } from "../plots/kinds/HeatMap";
import {
  elementsAlike,
  isOwn,
  mainPort,
  type OwnPlot,
  plotKinds,
  portAxes,
  portsOf,
  weightsOf,
} from "../plots/kinds/kinds";
import { Kernel } from "../plots/kinds/Kernel";
import { Multiples } from "../plots/kinds/Multiples";
import { PackagedPlot } from "../plots/kinds/PackagedPlot";
import { Phase } from "../plots/kinds/Phase";
import { Picture } from "../plots/kinds/Picture";
import type { PlotProps } from "../plots/PlotFrame";
import { type PlotParams, readParams, readSettings } from "../plots/settings";
import { SpaceTime } from "../plots/kinds/SpaceTime";
import { TimeCourse } from "../plots/kinds/TimeCourse";
import { Weights } from "../plots/kinds/Weights";
import { SideBySide } from "../replay/SideBySide";
import { useStudio } from "../store";
import { plotTitle } from "./openPlot";

// Loaded when they are first shown, as three.js is.
const Surface = lazy(async () => ({ default: (await import("../plots/kinds/Surface")).Surface }));
const Volume = lazy(async () => ({ default: (await import("../plots/kinds/Volume")).Volume }));

const PLOTS: Record<OwnPlot, ComponentType<PlotProps>> = {
  course: TimeCourse,
  curve: FieldCurve,
  heat: HeatMap,
  picture: Picture,
  space_time: SpaceTime,
  phase: Phase,
  surface: Surface,
  volume: Volume,
  kernel: Kernel,
  weights: Weights,
  multiples: Multiples,
};

export function PlotPanel({ api, params }: IDockviewPanelProps<Record<string, unknown>>) {
  const plot = readParams(params);
  const element = useStudio((state) => state.elements.get(plot.element));
  const port = useStudio(() =>
    element === undefined || portsOf(element).includes(plot.port)
      ? plot.port
      : mainPort(element, useStudio.getState().kinds.get(element.kind)),
  );
  const offered = useStudio(({ document, welcome, kinds: types }) =>
    element === undefined || document === null
      ? "course"
      : plotKinds(portAxes(document, element, port), welcome?.plots, {
          kernel: element.kernel,
          weights: weightsOf(document, element, types.get(element.kind)).length > 0,
          several: elementsAlike(document, element, port).length > 1,
        }).join(),
  );
  const visible = useVisible(api);
  const compared = useStudio((state) => state.comparison !== null);
  const kinds = offered.split(",");
  const kind = plot.kind !== null && kinds.includes(plot.kind) ? plot.kind : (kinds[0] ?? "course");

  const packaged = useStudio((state) => state.welcome?.plots.find((other) => other.name === kind));

  const title = element === undefined ? null : plotTitle({ element: plot.element, kind });
  useEffect(() => {
    if (title !== null) {
      api.setTitle(title);
    }
  }, [api, title]);

  if (element === undefined) {
    return (
      <div className="dock-gone" role="status">
        <p>The element of this plot is no longer in the document.</p>
        <button type="button" className="dock-button" onClick={() => api.close()}>
          Close this plot
        </button>
      </div>
    );
  }
  // Without a connection the arrangement, which has the settings of plots, is not kept.
  const change = (next: Partial<PlotParams>) => {
    if (useStudio.getState().connection === "open") {
      api.updateParameters({ ...plot, kind, port, ...next });
    }
  };
  const props: PlotProps = {
    element,
    port,
    kinds,
    settings: readSettings(plot.settings),
    visible,
    change,
    set: (settings) => change({ settings: { ...plot.settings, ...settings } }),
  };
  const Plot = isOwn(kind) ? PLOTS[kind] : null;
  const drawing =
    Plot !== null ? (
      <Suspense key={kind} fallback={null}>
        <Plot {...props} />
      </Suspense>
    ) : packaged === undefined ? null : (
      <PackagedPlot key={kind} plot={packaged} {...props} />
    );
  return compared ? <SideBySide key={kind}>{drawing}</SideBySide> : drawing;
}

function useVisible(api: IDockviewPanelProps["api"]): boolean {
  const [visible, setVisible] = useState(api.isVisible);
  useEffect(() => {
    setVisible(api.isVisible);
    const end = api.onDidVisibilityChange((event) => setVisible(event.isVisible));
    return () => end.dispose();
  }, [api]);
  return visible;
}
