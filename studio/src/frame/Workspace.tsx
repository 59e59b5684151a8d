// The body of an open document: palette, centre with the plots, and the dock of tools. What a tool does never
// changes the size of another part.

import { type ReactNode, useEffect, useLayoutEffect, useRef, useState, useSyncExternalStore } from "react";
import { PalettePanel } from "../palette/PalettePanel";
import { later } from "../widgets/Later";
import { NeedsServer } from "../widgets/NeedsServer";
import { Graph } from "../graph/Graph";
import { emptyPage, showView, usePage } from "../state/page";
import { viewOf } from "../state/person";
import { beginTiles, followTiles, tilesIn, useTiles } from "../state/tiles";
import { useStudio } from "../server/store";
import { live } from "../server/live";
import { Dock } from "./Dock";
import { firstTiles } from "../tiles/firstTiles";
import classes from "./Workspace.module.css";
import { TileGrid } from "../tiles/TileGrid";
import { TITLES } from "./titles";

// What a page does not need at first is loaded when it is first shown.
const Experiment = later(async () => (await import("../experiment/Experiment")).Experiment);
const World = later(async () => (await import("../world/World")).World);

export function Workspace() {
  const session = useStudio((state) => state.session);
  const begun = usePage((page) => page.session);
  useLayoutEffect(() => begin(session), [session]);
  useViewOfExperiment();
  return begun === session ? <Body key={session} /> : null;
}

// A new session begins with new, empty objects.
function begin(session: number): void {
  const { document, kinds } = useStudio.getState();
  if (document !== null && usePage.getState().session !== session) {
    const { layout, file } = document;
    const stored = viewOf(file) ?? layout.view;
    beginTiles(firstTiles(document, kinds), tilesNow);
    usePage.setState({ ...emptyPage(session, stored ?? "build"), chosen: stored !== null }, true);
  }
}

function Body() {
  const view = usePage((page) => page.view);
  const tiled = useTiles((state) => tilesIn(state, view).length > 0);
  useStoredTiles();
  useViewOfContent();
  // The canvas stays where it is when another view is shown.
  const [built, setBuilt] = useState(view === "build");
  useEffect(() => setBuilt((before) => before || view === "build"), [view]);
  return (
    <main className={classes.frame} data-view={view}>
      {view === "build" && (
        <Part title={TITLES.palette} className={classes.palette}>
          <NeedsServer>
            <PalettePanel />
          </NeedsServer>
        </Part>
      )}
      <div className={classes.centre} data-tiled={tiled || undefined}>
        {(built || view === "build") && (
          <Part title={TITLES.graph} className={classes.stage} hidden={view !== "build"}>
            <Graph />
          </Part>
        )}
        {view === "experiment" && (
          <Part title={TITLES.experiment} className={classes.stage}>
            <NeedsServer>
              <Experiment />
            </NeedsServer>
          </Part>
        )}
        {view === "robot" && (
          <Part title={TITLES.world} className={classes.stage}>
            <NeedsServer>
              <World />
            </NeedsServer>
          </Part>
        )}
        <TileGrid />
      </div>
      <Dock />
    </main>
  );
}

type PartProps = { title: string; className: string | undefined; hidden?: boolean; children: ReactNode };

function Part({ title, className, hidden = false, children }: PartProps) {
  return (
    <section aria-label={title} className={className} hidden={hidden}>
      {children}
    </section>
  );
}

const tilesNow = () => useStudio.getState().document?.layout.tiles ?? null;

// Undo, and other pages, change the plots of the document too.
function useStoredTiles(): void {
  const tiles = useStudio((state) => state.document?.layout.tiles);
  useEffect(followTiles, [tiles]);
}

// Where neither the document nor a person states a view, the page shows a world that can be seen, unless the
// person edits the architecture already. The world of the document before is none of this one.
function useViewOfContent(): void {
  const session = useStudio((state) => state.session);
  const edits = () => useStudio.getState().document?.undo;
  const [first] = useState(edits);
  const seen = useSyncExternalStore(live.listen, () => live.showsWorldOf(session));
  useEffect(() => {
    if (seen && !usePage.getState().chosen && edits() === first) {
      showView("robot", false);
    }
  }, [seen, first]);
}

// An experiment is shown when it is opened, and when a trial of it is repeated or left; the one that is open
// already when the page appears, where nothing else states a view.
function useViewOfExperiment(): void {
  const experiment = useStudio(({ experiment: open }) =>
    open === null || open.data === null ? "" : `${open.file} ${open.data["name"]} ${open.repeated}`,
  );
  const before = useRef<string | null>(null);
  useEffect(() => {
    const first = before.current === null;
    before.current = experiment;
    if (experiment !== "" && !(first && usePage.getState().chosen)) {
      showView("experiment", false);
    }
  }, [experiment]);
}
