// The panels of the page, which can be moved, stacked, closed and resized. Their arrangement is kept with the
// document.

import { type DockviewApi, DockviewReact, type DockviewReadyEvent, type DockviewTheme } from "dockview-react";
import "dockview-react/dist/styles/dockview.css";
import { type KeyboardEvent, useEffect, useRef, useState, useSyncExternalStore } from "react";
import { PalettePanel } from "../build/palette/PalettePanel";
import { CostsPanel } from "../costs/CostsPanel";
import { Experiment } from "../experiment/Experiment";
import { Graph } from "../graph/Graph";
import { Inspector } from "../inspector/Inspector";
import { NeedsServer } from "../connection/NeedsServer";
import { Pins } from "../pins/Pins";
import { RegimePanel } from "../regime/RegimePanel";
import { ReportPanel } from "../report/ReportPanel";
import { request } from "../socket";
import { useStudio } from "../store";
import { live } from "../world/live";
import { World } from "../world/World";
import { isChanged, found, type ArrangementFound, restore } from "./arrangement";
import { Empty } from "./Empty";
import { forgetArrangements, openFirstWorld, openTool, setDock } from "./openPlot";
import { PanelTab } from "./PanelTab";
import { PlotPanel } from "./PlotPanel";
import "./dock.css";

const COMPONENTS = {
  graph: () => <Graph />,
  inspector: () => (
    <NeedsServer>
      <Inspector />
    </NeedsServer>
  ),
  pins: () => (
    <NeedsServer>
      <Pins />
    </NeedsServer>
  ),
  costs: () => (
    <NeedsServer>
      <CostsPanel />
    </NeedsServer>
  ),
  regime: () => (
    <NeedsServer>
      <RegimePanel />
    </NeedsServer>
  ),
  report: () => <ReportPanel />,
  palette: () => (
    <NeedsServer>
      <PalettePanel />
    </NeedsServer>
  ),
  world: () => (
    <NeedsServer>
      <World />
    </NeedsServer>
  ),
  experiment: () => (
    <NeedsServer>
      <Experiment />
    </NeedsServer>
  ),
  plot: PlotPanel,
};

// Panels are parted by a gap through which the ground shows: lines above them would be drawn over every plot
// again and again.
const THEME: DockviewTheme = { name: "deodar", className: "dock-theme", dndPanelOverlay: "group", gap: 1 };
const SAVE_AFTER_MS = 600;

export function Dock() {
  const [api, setApi] = useState<DockviewApi | null>(null);
  const session = useStudio((state) => state.session);
  const saved = useRef<ArrangementFound | null>(null);

  const ready = ({ api: made }: DockviewReadyEvent) => {
    setDock(made);
    setApi(made);
  };
  useEffect(() => () => setDock(null), []);

  useEffect(() => {
    if (api === null) {
      return;
    }
    let timer: ReturnType<typeof setTimeout> | undefined;
    restore(api, useStudio.getState().document?.layout["panels"]);
    forgetArrangements();
    saved.current = found(api);
    const save = () => {
      const [before, now] = [saved.current, found(api)];
      saved.current = now;
      if (before !== null && isChanged(before, now)) {
        void request({ type: "arrange", layout: { panels: api.toJSON() }, undoable: false });
      }
    };
    const later = () => {
      clearTimeout(timer);
      timer = setTimeout(save, SAVE_AFTER_MS);
    };
    const watch = api.panels.map((panel) => panel.api.onDidParametersChange(later));
    const ends = [
      api.onDidLayoutChange(later),
      api.onDidAddPanel((panel) => watch.push(panel.api.onDidParametersChange(later))),
    ];
    return () => {
      clearTimeout(timer);
      [...watch, ...ends].forEach((end) => end.dispose());
    };
  }, [api, session]);

  // What the page opens by itself is no arrangement of a person, and not stored.
  // A world with a view from above, or in another process, is shown, unless the document stores an
  // arrangement of panels.
  const shown = () => live.scene() !== null || live.link() !== null;
  const seen = useSyncExternalStore(live.listen, shown);
  useEffect(() => {
    if (api !== null && seen && useStudio.getState().document?.layout["panels"] === undefined) {
      openFirstWorld();
      saved.current = found(api);
    }
  }, [api, session, seen]);

  // So is an experiment that was opened.
  const experiment = useStudio((state) => state.experiment !== null && state.experiment.data !== null);
  useEffect(() => {
    if (api !== null && experiment) {
      openTool("experiment");
      saved.current = found(api);
    }
  }, [api, session, experiment]);

  const closeByKey = (event: KeyboardEvent) => {
    const tab = event.key === "Delete" ? (event.target as HTMLElement).closest("[role=tab]") : null;
    const panel = api?.getPanel(tab?.getAttribute("data-tab-panel-id") ?? "");
    if (panel !== undefined) {
      event.stopPropagation();
      panel.api.close();
    }
  };
  return (
    <div className="dock" onKeyDown={closeByKey}>
      <DockviewReact
        components={COMPONENTS}
        defaultTabComponent={PanelTab}
        watermarkComponent={Empty}
        theme={THEME}
        onReady={ready}
      />
    </div>
  );
}
