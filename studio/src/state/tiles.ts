// The plots of the open document, a list for each view. A change by a person is a step of undo of the
// document; a view without a list of its own shows that of Build.

import { create } from "zustand";
import type { PlotParams } from "../model/settings";
import { same } from "../model/part";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { type View, VIEWS } from "./page";

export type PlotTile = Readonly<PlotParams & { key: number }>;

export type PlotLists = Readonly<Partial<Record<View, readonly PlotParams[]>>>;

type TileLists = Readonly<Partial<Record<View, readonly PlotTile[]>>>;

export type TilesState = Readonly<{
  next: number;
  views: TileLists;
  // Those that the document was opened with.
  opened: PlotLists;
}>;

const NONE: readonly PlotTile[] = [];
// Settings and places change often during one movement of the mouse.
const SAVE_AFTER_MS = 600;

export const useTiles = create<TilesState>(() => ({ next: 0, views: {}, opened: {} }));

export const tilesIn = ({ views }: TilesState, view: View): readonly PlotTile[] =>
  views[view] ?? views.build ?? NONE;

// `read` returns the plots that the document has now; null: none of its own.
export function beginTiles(opened: PlotLists, read: () => PlotLists | null): void {
  clearTimeout(timer);
  unsaved = false;
  ofDocument = read;
  unanswered.clear();
  useTiles.setState({ opened, ...keyed(opened, {}, 0) }, true);
}

// Add a tile at the end of a view; its key.
export function addTile(view: View, plot: PlotParams): number {
  const state = useTiles.getState();
  useTiles.setState({ next: state.next + 1 });
  setTiles(view, [...tilesIn(state, view), { ...plot, key: state.next }]);
  saveTiles();
  return state.next;
}

export function changeTile(view: View, key: number, plot: PlotParams): void {
  const tiles = tilesIn(useTiles.getState(), view);
  setTiles(
    view,
    tiles.map((tile) => (tile.key === key ? { ...plot, key } : tile)),
  );
  saveSoon();
}

export function removeTile(view: View, key: number): void {
  setTiles(
    view,
    tilesIn(useTiles.getState(), view).filter((tile) => tile.key !== key),
  );
  saveTiles();
}

// Put a tile in the place of another one. What a drag moves is stored at its end, by `settleTiles`.
export function moveTile(view: View, key: number, to: number): void {
  const tiles = tilesIn(useTiles.getState(), view);
  const moved = tiles.find((tile) => tile.key === key);
  if (moved !== undefined && to >= 0 && to < tiles.length && tiles[to] !== moved) {
    setTiles(view, tiles.filter((tile) => tile !== moved).toSpliced(to, 0, moved));
  }
}

// Show the plots that the document was opened with.
export function restoreTiles(): void {
  const { opened } = useTiles.getState();
  if (!isSame(opened)) {
    useTiles.setState((state) => keyed(opened, state.views, state.next));
    saveTiles();
  }
}

// Take over the plots that the document has now, after undo or a change on another page. What this page sends
// at the same time replaces them.
export function followTiles(): void {
  const wanted = stored();
  if (!unsaved && unanswered.size === 0 && !isSame(wanted)) {
    useTiles.setState((state) => keyed(wanted, state.views, state.next));
  }
}

const stored = (): PlotLists => ofDocument() ?? useTiles.getState().opened;

let ofDocument: () => PlotLists | null = () => null;
// Whether the page has others than it stored.
let unsaved = false;

let timer: ReturnType<typeof setTimeout> | undefined;
const unanswered = new Set<object>();

// Store what changed now: at the end of a drag, before a step of undo, and before the document is saved or
// left.
export function settleTiles(): void {
  if (unsaved) {
    saveTiles();
  }
}

function setTiles(view: View, tiles: readonly PlotTile[]): void {
  unsaved = true;
  useTiles.setState(({ views }) => ({ views: { ...views, [view]: tiles } }));
}

function saveSoon(): void {
  clearTimeout(timer);
  timer = setTimeout(saveTiles, SAVE_AFTER_MS);
}

function saveTiles(): void {
  clearTimeout(timer);
  unsaved = false;
  const { document, connection } = useStudio.getState();
  const isKnown = unanswered.size === 0 && isSame(stored());
  if (document === null || connection !== "open" || isKnown) {
    return;
  }
  const asked = {};
  unanswered.add(asked);
  // what the document had meanwhile, by another page or a step of undo, is shown after the last answer
  const answered = () => {
    if (unanswered.delete(asked) && unanswered.size === 0) {
      followTiles();
    }
  };
  const tiles = plain(useTiles.getState().views);
  // what is undone is a document, not a record
  const undoable = document.record == null;
  request({ type: "arrange", layout: { tiles }, undoable }).then(answered, answered);
}

function plain(views: TileLists): PlotLists {
  return Object.fromEntries(
    Object.entries(views).map(([view, tiles]) => [view, tiles.map(({ key: _, ...plot }) => plot)]),
  );
}

function isSame(wanted: PlotLists): boolean {
  const shown = plain(useTiles.getState().views);
  return VIEWS.every((view) => same(shown[view], wanted[view]));
}

// A plot that is shown already keeps its tile, and with it the past that it draws.
function keyed(plots: PlotLists, before: TileLists, next: number): Pick<TilesState, "next" | "views"> {
  const views = Object.fromEntries(
    Object.entries(plots).map(([view, list]) => {
      const rest = [...(before[view as View] ?? before.build ?? [])];
      const keyOf = ({ element, kind, port }: PlotParams) => {
        const i = rest.findIndex(
          (tile) => tile.element === element && tile.kind === kind && tile.port === port,
        );
        return i < 0 ? next++ : (rest.splice(i, 1)[0]?.key ?? next++);
      };
      return [view, list.map((plot) => ({ ...plot, key: keyOf(plot) }))];
    }),
  );
  return { next, views };
}
