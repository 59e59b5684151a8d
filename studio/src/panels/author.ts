// What the author of a document decides about its frame: the view in which it opens, and the plots.

import { request } from "../socket";
import { emptyPage, isView, showView, usePage, type View } from "../state/page";
import { changePerson, STANDARD, usePerson } from "../state/person";
import { restoreTiles } from "../state/tiles";
import { useStudio } from "../store";

// The view that the document states; null: none.
export function viewOfAuthor(layout: Record<string, unknown>): View | null {
  return isView(layout["view"]) ? layout["view"] : null;
}

// Show views, tools and plots as the document was opened first.
export function restoreFrame(): void {
  const { tabs, opened } = emptyPage(0);
  const { document } = useStudio.getState();
  const { [document?.file ?? ""]: _, ...views } = usePerson.getState().views;
  changePerson({ ...STANDARD, views });
  usePage.setState({ tabs, opened });
  showView(viewOfAuthor(document?.layout ?? {}) ?? "build");
  restoreTiles();
}

// From now on the document opens in the view that is shown, as one step of undo.
export function openInThisView(): void {
  void request({ type: "arrange", layout: { view: usePage.getState().view }, undoable: true });
}
