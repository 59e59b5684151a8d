// The list of all kinds beside the canvas, with names where there is room: a line is dragged to the canvas,
// or clicked.

import { ActionIcon, Tooltip } from "@mantine/core";
import { IconLayoutSidebarLeftCollapse, IconLayoutSidebarLeftExpand } from "@tabler/icons-react";
import { useMemo } from "react";

import { changePerson, usePerson } from "../state/person";
import { useStudio } from "../server/store";
import { addElement } from "../actions/edits";
import { carriedBy, carry } from "../actions/carried";
import type { ListEntry } from "../model/entries";
import { EntryList } from "./EntryList";
import {
  type Add,
  kindEntries,
  type Selected,
  signalEntries,
  spotFor,
  templateEntries,
} from "../actions/palette";
import { Sketch } from "../widgets/Sketch";

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
  const named = usePerson((person) => person.palette);
  const Icon = named ? IconLayoutSidebarLeftCollapse : IconLayoutSidebarLeftExpand;
  return (
    <div className="palette-panel" inert={record} data-named={named || undefined}>
      <div className="palette-names down">
        <EntryList
          label="Elements to add"
          placeholder="Add an element"
          entries={entries}
          empty="No kind matches"
          brief
          draggable
          onChoose={(entry) => entry.run?.()}
        />
      </div>
      <div className="palette-sketches down">
        {entries.map((entry) => entry.kind !== undefined && <SketchButton key={entry.id} entry={entry} />)}
      </div>
      <ActionIcon
        size={28}
        className="palette-fold"
        aria-label={named ? "Fold the list of elements" : "Show the names of elements"}
        onClick={() => changePerson({ palette: !named })}
      >
        <Icon size={16} />
      </ActionIcon>
    </div>
  );
}

// Keys open the list of the canvas instead.
function SketchButton({ entry }: { entry: ListEntry }) {
  const carried = carriedBy(entry);
  return (
    <Tooltip label={entry.why ?? entry.title} position="right">
      <button
        type="button"
        tabIndex={-1}
        className="palette-sketch"
        aria-label={entry.title}
        aria-disabled={entry.why !== undefined}
        draggable={carried !== null}
        onDragStart={(event) => carried !== null && carry(event.dataTransfer, carried)}
        onClick={() => entry.why === undefined && entry.run?.()}
      >
        {entry.kind !== undefined && <Sketch kind={entry.kind} />}
      </button>
    </Tooltip>
  );
}
