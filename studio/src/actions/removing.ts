// Removes what is selected: elements, groups, connections.

import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { useChooser } from "../state/choice";
import { endsOf } from "../model/ends";
import { isEditable } from "../state/editable";
import { usePicked } from "./picked";
import { chosen } from "./selection";
import { contentOf, isDrawn } from "./wires";

const SHARED =
  "All couplings of this wire belong to other wires too. Show every element to remove one of them.";

export async function removeSelected(): Promise<void> {
  if (!isEditable()) {
    return;
  }
  const { elements, groups } = chosen();
  const wires = usePicked.getState().wires.filter(isDrawn).map(contentOf);
  const all = [...new Set([...elements, ...wires.flatMap((wire) => wire.elements)])];
  const connections = wires.flatMap((wire) => wire.connections);
  if (all.length + groups.length + connections.length === 0) {
    if (wires.length > 0) {
      useStudio.getState().notify({ what: SHARED }, "info");
    }
    return;
  }
  const { problems = [] } = await request({ type: "remove", elements: all, groups, connections });
  if (problems.length === 0) {
    usePicked.setState({ wires: [], groups: [] });
    useStudio.getState().select([]);
  }
}

// List the connections of the selected element; the one that is chosen is removed.
export function disconnectByKeys(): void {
  const { selected, elements, document } = useStudio.getState();
  const path = (id: string) => elements.get(id)?.path ?? id;
  const own = (document?.connections ?? []).filter(
    ({ source, target }) => selected.includes(source) || selected.includes(target),
  );
  if (own.length === 0) {
    useStudio.getState().notify({ what: "Select an element with a connection to remove it." }, "info");
    return;
  }
  useChooser.getState().open({
    label: "Remove a connection",
    placeholder: "Element at the other end",
    at: null,
    entries: own.map((c) => ({
      id: Object.values(endsOf(c)).join(" "),
      family: selected.includes(c.source) ? "From the selected element" : "To the selected element",
      title: `${path(c.source)} to ${path(c.target)}`,
      run: () => request({ type: "disconnect", ...endsOf(c) }),
    })),
    empty: "No connection matches",
  });
}
