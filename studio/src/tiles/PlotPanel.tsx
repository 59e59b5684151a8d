// The plot of a tile: finds its element and the component for the kind of plot.

import type { ComponentType } from "react";
import { later } from "../widgets/Later";
import { elementsAlike, mainPort, portAxes, portsOf, weightsOf } from "../model/ports";
import { PackagedPlot } from "../plots/PackagedPlot";
import { PLOTS, plotKinds } from "../plots/kinds/plots";
import type { PlotProps } from "../plots/PlotFrame";
import { Tile } from "../plots/Tile";
import { type PlotParams, readSettings } from "../model/settings";
import { SideBySide } from "../replay/SideBySide";
import type { View } from "../state/page";
import { changeTile, type PlotTile } from "../state/tiles";
import { useStudio } from "../server/store";

type Components = Record<string, ComponentType<PlotProps>>;

// What draws with three.js is loaded when it is first shown.
const FILES = import.meta.glob<Components>("../plots/scenes/*.tsx");

function componentOf(name: string): ComponentType<PlotProps> {
  return later(async () => {
    const found = (await FILES[`../plots/scenes/${name}.tsx`]?.())?.[name];
    if (found === undefined) throw new Error(`No file has the component ${name}.`);
    return found;
  });
}

const SCENES = new Map(
  [...PLOTS].flatMap(([name, plot]) => ("component" in plot ? [[name, componentOf(plot.component)]] : [])),
);

export function PlotPanel({ tile, view, visible }: { tile: PlotTile; view: View; visible: boolean }) {
  const { key, ...plot } = tile;
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
  const compared = useStudio((state) => state.comparison !== null);
  const kinds = offered.split(",");
  const kind = plot.kind !== null && kinds.includes(plot.kind) ? plot.kind : (kinds[0] ?? "course");

  const packaged = useStudio((state) => state.welcome?.plots.find((other) => other.name === kind));

  if (element === undefined) {
    return (
      <p className="plot-message" role="status">
        The element of this plot is no longer in the document.
      </p>
    );
  }
  // Without a connection the settings of plots are not kept.
  const change = (next: Partial<PlotParams>) => {
    if (useStudio.getState().connection === "open") {
      changeTile(view, key, { ...plot, kind, port, ...next });
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
  const plotted = PLOTS.get(kind);
  const Scene = SCENES.get(kind);
  const drawing =
    Scene !== undefined ? (
      <Scene key={kind} {...props} />
    ) : plotted !== undefined && !("component" in plotted) ? (
      <Tile key={kind} kind={kind} plot={plotted} {...props} />
    ) : packaged === undefined ? null : (
      <PackagedPlot key={kind} plot={packaged} {...props} />
    );
  return compared ? <SideBySide key={kind}>{drawing}</SideBySide> : drawing;
}
