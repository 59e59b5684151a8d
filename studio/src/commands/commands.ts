// All commands, elements and kinds in one list (Ctrl+K), and those for the selection at a right click.

import { exportScript } from "../files/flows";
import type { Point } from "../model/rects";
import { keysText } from "../model/keys";
import { onCanvas, showGoal } from "../actions/showGoal";
import type { Shortcut } from "../model/keys";
import { useStudio } from "../server/store";
import { ALIGNMENTS, align } from "../actions/aligning";
import { useChooser } from "../state/choice";
import { addElement } from "../actions/edits";
import type { ListEntry } from "../model/entries";
import { isEditable } from "../state/editable";
import {
  type Add,
  kindEntries,
  knownTemplates,
  selectedOne,
  signalEntries,
  spotFor,
  templateEntries,
} from "../actions/palette";
import { getPointer } from "../actions/stage";

// Commands without keys.
const WITHOUT_KEYS: ListEntry[] = [
  {
    id: "command export script",
    family: "Commands",
    title: "Export as Python script",
    words: "code download",
    run: exportScript,
  },
];

export function openCommands(shortcuts: readonly Shortcut[]): void {
  const { kinds, offered } = useStudio.getState();
  const at = getPointer();
  const add: Add = (kind, values, name) => addElement(kind.name, spotFor(kind, at), { values, name });
  const added = isEditable()
    ? [
        ...kindEntries(kinds, selectedOne(), add),
        ...signalEntries(offered, kinds, add),
        ...templateEntries(knownTemplates(), at),
      ]
    : [];
  useChooser.getState().open({
    label: "Commands and elements",
    placeholder: "A command, an element, or a kind to add",
    at: null,
    entries: [
      ...commandEntries(shortcuts),
      ...WITHOUT_KEYS,
      ...alignmentEntries(),
      ...elementEntries(),
      ...added.map((entry) => ({
        ...entry,
        family: `Add: ${entry.family.toLowerCase()}`,
        run: () => onCanvas(() => entry.run?.()),
      })),
    ],
    empty: "Nothing matches",
  });
}

// The elements alone, in the order of their paths.
export function openSearch(): void {
  useChooser.getState().open({
    label: "Search for an element",
    placeholder: "Name, path or kind",
    at: null,
    entries: elementEntries().sort((a, b) => a.title.localeCompare(b.title)),
    empty: "No element matches",
  });
}

function elementEntries(): ListEntry[] {
  const { document, kinds } = useStudio.getState();
  return (document?.elements ?? []).map(({ id, path, kind }) => ({
    id: `element ${id}`,
    family: "Go to",
    title: path,
    note: kinds.get(kind)?.title ?? kind,
    words: kind,
    run: () => showGoal({ element: id }),
  }));
}

// What can be done with the selection.
export function openSelectionCommands(at: Point, shortcuts: readonly Shortcut[]): void {
  useChooser.getState().open({
    label: "Commands for the selection",
    placeholder: "Command",
    at,
    entries: [...commandEntries(shortcuts.filter(({ canvas }) => canvas === true)), ...alignmentEntries()],
    empty: "No command matches",
  });
}

function commandEntries(shortcuts: readonly Shortcut[]): ListEntry[] {
  return shortcuts.map(({ keys, does, run }) => ({
    id: `command ${does}`,
    family: "Commands",
    title: does,
    note: keys.map((key) => keysText(key)).join(" or "),
    run,
  }));
}

function alignmentEntries(): ListEntry[] {
  return ALIGNMENTS.map((alignment) => ({
    id: `command ${alignment.does}`,
    family: "Align and distribute",
    title: alignment.does,
    run: () => align(alignment),
  }));
}
