// The plots of the open document, a list for each view. They are kept with the document when a person changes
// them; a view without a list of its own shows that of Build.

import { create } from "zustand";
import type { PlotParams } from "../plots/settings";
import { request } from "../socket";
import { useStudio } from "../store";
import type { View } from "./page";

export type PlotTile = Readonly<PlotParams & { key: number }>;

export type TilesState = Readonly<{
  session: number;
  next: number;
  views: Readonly<Partial<Record<View, readonly PlotTile[]>>>;
}>;

const NONE: readonly PlotTile[] = [];
const SAVE_AFTER_MS = 600;

export const useTiles = create<TilesState>(() => ({ session: 0, next: 0, views: {} }));

export const tilesIn = ({ views }: TilesState, view: View): readonly PlotTile[] =>
  views[view] ?? views.build ?? NONE;

export function beginTiles(session: number, plots: Partial<Record<View, readonly PlotParams[]>>): void {
  let next = 0;
  const views = Object.fromEntries(
    Object.entries(plots).map(([view, list]) => [view, list.map((plot) => ({ ...plot, key: next++ }))]),
  );
  useTiles.setState({ session, next, views }, true);
}

// Add a tile at the end of a view; its key.
export function addTile(view: View, plot: PlotParams): number {
  const state = useTiles.getState();
  useTiles.setState({ next: state.next + 1 });
  setTiles(view, [...tilesIn(state, view), { ...plot, key: state.next }]);
  return state.next;
}

export function changeTile(view: View, key: number, plot: PlotParams): void {
  setTiles(
    view,
    tilesIn(useTiles.getState(), view).map((tile) => (tile.key === key ? { ...plot, key } : tile)),
  );
}

export function removeTile(view: View, key: number): void {
  setTiles(
    view,
    tilesIn(useTiles.getState(), view).filter((tile) => tile.key !== key),
  );
}

// Put a tile in the place of another one.
export function moveTile(view: View, key: number, to: number): void {
  const tiles = tilesIn(useTiles.getState(), view);
  const moved = tiles.find((tile) => tile.key === key);
  if (moved !== undefined && to >= 0 && to < tiles.length && tiles[to] !== moved) {
    setTiles(view, tiles.filter((tile) => tile !== moved).toSpliced(to, 0, moved));
  }
}

let timer: ReturnType<typeof setTimeout> | undefined;

function setTiles(view: View, tiles: readonly PlotTile[]): void {
  const { session, views } = useTiles.getState();
  useTiles.setState({ views: { ...views, [view]: tiles } });
  clearTimeout(timer);
  timer = setTimeout(() => useTiles.getState().session === session && save(), SAVE_AFTER_MS);
}

function save(): void {
  const { document, connection } = useStudio.getState();
  if (document === null || connection !== "open") {
    return;
  }
  const tiles = Object.fromEntries(
    Object.entries(useTiles.getState().views).map(([view, list]) => [
      view,
      list.map(({ key: _, ...plot }) => plot),
    ]),
  );
  // an old arrangement of panels is replaced
  const old = document.layout["panels"] === undefined ? {} : { panels: null };
  void request({ type: "arrange", layout: { tiles, ...old }, undoable: false });
}
