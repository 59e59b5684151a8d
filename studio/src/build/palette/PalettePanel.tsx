// The list of all kinds as a panel: a line is dragged to the canvas, or clicked.

import { useMemo } from "react";

import { useStudio } from "../../store";
import { addElement } from "../edits";
import { EntryList } from "./EntryList";
import { type Add, kindEntries, type Selected, signalEntries, spotFor, templateEntries } from "./palette";

export function PalettePanel() {
  const kinds = useStudio((state) => state.kinds);
  const record = useStudio((state) => state.document?.record != null);
  const only = useStudio((state) => (state.selected.length === 1 ? (state.selected[0] ?? "") : ""));
  const name = useStudio((state) => state.elements.get(only)?.name ?? "");
  const templates = useStudio((state) => state.welcome?.templates);
  const kind = useStudio((state) => state.kinds.get(state.elements.get(only)?.kind ?? ""));
  const offered = useStudio((state) => state.offered);
  const entries = useMemo(() => {
    const selected: Selected | null = kind === undefined ? null : { id: only, name, kind };
    const add: Add = (chosen, values, called) =>
      addElement(chosen.name, spotFor(chosen, null), { values, name: called });
    return [
      ...kindEntries(kinds, selected, add),
      ...signalEntries(offered, kinds, add),
      ...templateEntries(templates ?? [], null),
    ];
  }, [kinds, templates, offered, only, name, kind]);
  return (
    <div className="palette-panel" inert={record}>
      <EntryList
        label="Elements to add"
        placeholder="Name, family or parameter"
        entries={entries}
        empty="No kind matches"
        draggable
        onChoose={(entry) => entry.run?.()}
      />
    </div>
  );
}
