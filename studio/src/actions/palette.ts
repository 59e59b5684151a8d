// The palette: every registered kind, to add elements at the pointer and parts to the selected element.

import type { Point } from "../model/rects";
import type { Kinds } from "../model/leaf";
import { axesOver } from "../model/elementAxes";
import type { Kind, TemplateView, WorldSignals } from "../protocol";
import { useStudio } from "../server/store";
import type { Values } from "../model/values";
import { useChooser } from "../state/choice";
import { addComment } from "./commenting";
import { addElement, addPart, addTemplate } from "./edits";
import type { ListEntry } from "../model/entries";
import { isEditable } from "../state/editable";
import { ELEMENTS, familyOf, isPart, isSource, takes } from "../model/families";
import { DRAWN, shapeOf } from "../model/shapes";
import { afterAll, beside, near, type Placing, sizeOfKind, under } from "./placing";
import { getPointer, getStage, middleOf } from "./stage";
import { roomFor } from "./inserting";
import { firstOf } from "./wires";

export type Add = (kind: Kind, values?: Values, name?: string) => unknown;

// All kinds as entries; `add` adds an element, whose axes follow from what it is connected with, or, where it
// is added alone, from the entry.
export function kindEntries(kinds: Kinds, selected: Selected | null, add: Add, alone = true): ListEntry[] {
  const shapes = Object.keys(DRAWN);
  const rank = (kind: Kind) => shapes.indexOf(shapeOf(kind, kinds));
  const known = [...kinds.values()]
    .filter((kind) => familyOf(kind) !== null)
    .sort((a, b) => rank(a) - rank(b) || a.title.localeCompare(b.title));
  const elements = ELEMENTS.flatMap((family) =>
    known
      .filter((kind) => familyOf(kind) === family)
      .flatMap((kind) =>
        alone && hasDimensions(kind, kinds)
          ? DIMENSIONS.map((count) => dimensionEntry(kind, count, add))
          : [elementEntry(kind, add)],
      ),
  );
  const parts = known.filter(isPart).flatMap((kind) => partEntries(kind, selected));
  return [...elements, ...parts];
}

// The sensors and motors of worlds, with their axes.
export function signalEntries(worlds: readonly WorldSignals[], kinds: Kinds, add: Add): ListEntry[] {
  return worlds.flatMap(({ world, signals }) =>
    signals.flatMap(({ kind: of, name, title, meaning, values }) => {
      const kind = kinds.get(of);
      if (kind === undefined) {
        return [];
      }
      return {
        id: `${world} ${of} ${name}`,
        family: `Sensors and motors of ${world}`,
        title,
        kind,
        words: `${name} ${meaning} ${kind.title}`,
        values: () => values,
        called: name,
        run: () => add(kind, values, name),
      };
    }),
  );
}

const DIMENSIONS = [1, 2, 3];

// Whether a kind is a field, which is built over one, two or three dimensions.
const hasDimensions = (kind: Kind, kinds: Kinds): boolean =>
  shapeOf(kind, kinds) === "peak" && Object.keys(kind.levels).length > 0;

function dimensionEntry(kind: Kind, count: number, add: Add): ListEntry {
  const values = () => {
    const { document } = useStudio.getState();
    return document === null ? {} : { axes: axesOver(count, document) };
  };
  const entry = elementEntry(kind, (chosen) => add(chosen, values()));
  return { ...entry, id: `${kind.name} ${count}`, title: `${kind.title}, ${count}-D`, values };
}

export function elementEntry(kind: Kind, add: (kind: Kind) => unknown): ListEntry {
  return {
    id: kind.name,
    family: familyOf(kind) ?? "",
    title: kind.title,
    kind,
    words: `${kind.name} ${wordsOf(kind)}`,
    run: () => add(kind),
  };
}

const ROOMS = { architectures: "Architectures, added whole", examples: "Examples, added whole" };

// Published architectures and examples, each added as a group.
export function templateEntries(templates: TemplateView[], at: Point | null): ListEntry[] {
  return templates.map((template) => ({
    id: `template ${template.name}`,
    family: ROOMS[template.room],
    title: template.title,
    template,
    words: `${template.name} ${template.sentence} template model`,
    run: () => addTemplate(template.name, spotFor(null, at)),
  }));
}

export type Selected = { id: string; name: string; kind: Kind | undefined };

function partEntries(kind: Kind, selected: Selected | null): ListEntry[] {
  const family = familyOf(kind) ?? "";
  const entry = { family, title: kind.title, kind, words: `${kind.name} ${wordsOf(kind)}` };
  const places = selected === null ? [] : takes(selected.kind, kind);
  if (selected === null || places.length === 0) {
    return [{ ...entry, id: kind.name, why: `Select an element that has ${family.toLowerCase()}` }];
  }
  return places.map(({ name, several }) => ({
    ...entry,
    id: `${kind.name} ${name}`,
    note: places.length > 1 ? `${name.replaceAll("_", " ")} of ${selected.name}` : `for ${selected.name}`,
    run: () => addPart(selected.id, name, several, kind),
  }));
}

function wordsOf(kind: Kind): string {
  return kind.parameters.map((form) => `${form.name.replaceAll("_", " ")} ${form.meaning}`).join(" ");
}

// The one selected element.
export function selectedOne(): Selected | null {
  const { selected, elements, kinds } = useStudio.getState();
  const found = selected.length === 1 ? elements.get(selected[0] as string) : undefined;
  return found === undefined ? null : { id: found.id, name: found.name, kind: kinds.get(found.kind) };
}

// Open the palette at a position on the screen, without one at the pointer. An element is inserted into
// `into`, a connection on the canvas, if that is given.
export function openPalette(at: Point | null = getPointer(), into?: string): void {
  const { kinds, offered } = useStudio.getState();
  const wire = into === undefined ? undefined : firstOf(into);
  if (!isEditable() || getStage() === null || wire === null) {
    return;
  }
  const add: Add = (kind, values, name) =>
    addElement(kind.name, spotFor(kind, at, into), { wire, values, name });
  const entries = kindEntries(kinds, selectedOne(), add, wire === undefined);
  useChooser.getState().open({
    label: wire === undefined ? "Add an element" : "Insert an element",
    placeholder: "Name, family or parameter",
    at,
    entries:
      wire === undefined
        ? [
            ...entries,
            ...signalEntries(offered, kinds, add),
            commentEntry(at),
            ...templateEntries(knownTemplates(), at),
          ]
        : entries.filter(({ kind }) => kind !== undefined && passes(kind)),
    empty: "No kind matches",
  });
}

export const knownTemplates = (): TemplateView[] => useStudio.getState().welcome?.templates ?? [];

function commentEntry(at: Point | null): ListEntry {
  return {
    id: "comment",
    family: "On the canvas alone",
    title: "Comment",
    words: "note text",
    run: () => addComment(at),
  };
}

// A kind with an input, of which a connection can pass through the elements.
export const passes = (kind: Kind): boolean => !isPart(kind) && !isSource(kind);

// At the pointer; otherwise beside the selected element, sources at its left; otherwise in the middle. A
// template (no kind) comes right of everything. What is inserted into a connection makes room.
export function spotFor(kind: Kind | null, at: Point | null, into?: string): Placing {
  const stage = getStage();
  if (stage === null) {
    return { at: { x: 0, y: 0 }, group: "" };
  }
  const scene = stage.scene();
  const size = sizeOfKind(kind ?? undefined);
  const beyond = kind === null ? afterAll(scene) : null;
  if (beyond !== null) {
    return beyond;
  }
  if (at !== null) {
    const { x, y } = stage.toFlow(at);
    const corner = { x: x - size.width / 2, y: y - size.height / 2 };
    return roomFor(into, corner, size, kind?.room) ?? under({ x, y }, scene, size);
  }
  const selected = selectedOne();
  if (kind !== null && selected !== null && !scene.pills.has(selected.id)) {
    return beside(selected.id, !isSource(kind), scene, size);
  }
  return near(middleOf(stage), scene, size);
}
