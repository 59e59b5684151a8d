// What the author of a document decides about its frame: the view in which it opens, and the plots.

import { request } from "../server/socket";
import { emptyPage, showView, usePage } from "../state/page";
import { changePerson, STANDARD, usePerson } from "../state/person";
import { restoreTiles } from "../state/tiles";
import { useStudio } from "../server/store";

// Show views, tools and plots as the document was opened first.
export function restoreFrame(): void {
  const { tabs, opened } = emptyPage(0);
  const { document } = useStudio.getState();
  const { [document?.file ?? ""]: _, ...views } = usePerson.getState().views;
  changePerson({ ...STANDARD, views });
  usePage.setState({ tabs, opened });
  showView(document?.layout.view ?? "build");
  restoreTiles();
}

// From now on the document opens in the view that is shown, as one step of undo.
export function openInThisView(): void {
  void request({ type: "arrange", layout: { view: usePage.getState().view }, undoable: true });
}
