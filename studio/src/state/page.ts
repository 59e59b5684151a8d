// What the page holds in memory while one document is open: a new session gets a new, empty object, so that
// nothing has to be reset by hand.

import { pageStore } from "./pageStore";

export const VIEWS = ["build", "run", "experiment", "robot"] as const;

export type View = (typeof VIEWS)[number];

export type PageState = Readonly<{
  session: number;
  view: View;
  // Whether a person chose the view, which the page does not change then.
  chosen: boolean;
  // The tool that the dock shows in each view; without one, what the person used last there.
  tabs: Readonly<Partial<Record<View, string>>>;
  // The tools that were opened in any view, the newest last.
  opened: readonly string[];
  // The key of the tile that covers the centre.
  enlarged: number | null;
  // Whether the gallery covers the document.
  gallery: boolean;
}>;

export const emptyPage = (session: number, view: View = "build"): PageState => ({
  session,
  view,
  chosen: false,
  tabs: {},
  opened: [],
  enlarged: null,
  gallery: false,
});

export const usePage = pageStore<PageState>(() => emptyPage(0));

export const isView = (value: unknown): value is View => VIEWS.includes(value as View);

// Without `chosen` the page shows the view by itself.
export function showView(view: View, chosen = true): void {
  usePage.setState((page) => ({ view, chosen: chosen || page.chosen, enlarged: null }));
}
