// The list of all kinds as a panel: a line is dragged to the canvas, or clicked.

import { useMemo } from "react";

import { useStudio } from "../../store";
import { addElement } from "../edits";
import { EntryList } from "./EntryList";
import { kindEntries, type Selected, spotFor, templateEntries } from "./palette";

export function PalettePanel() {
  const kinds = useStudio((state) => state.kinds);
  const record = useStudio((state) => state.document?.record != null);
  const only = useStudio((state) => (state.selected.length === 1 ? (state.selected[0] ?? "") : ""));
  const name = useStudio((state) => state.elements.get(only)?.name ?? "");
  const templates = useStudio((state) => state.welcome?.templates);
  const kind = useStudio((state) => state.kinds.get(state.elements.get(only)?.kind ?? ""));
  const entries = useMemo(() => {
    const selected: Selected | null = kind === undefined ? null : { id: only, name, kind };
    return [
      ...kindEntries(kinds, selected, (chosen, values) =>
        addElement(chosen.name, spotFor(chosen, null), { values }),
      ),
      ...templateEntries(templates ?? [], null),
    ];
  }, [kinds, templates, only, name, kind]);
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
