// A list with a search: typed words find an entry, the arrow keys move, Enter or a click chooses.

import { TextInput } from "@mantine/core";
import { IconSearch } from "@tabler/icons-react";
import { type KeyboardEvent, useEffect, useId, useMemo, useState } from "react";

import "./chooser.css";
import { type ListEntry, search } from "../model/entries";
import { grouped } from "../model/values";
import { carriedBy, carry } from "../actions/carried";
import type { Kind, TemplateView } from "../protocol";
import { Tex } from "../widgets/Tex";
import { Sketch, TemplatePicture } from "../widgets/Sketch";

type Props = {
  label: string;
  placeholder: string;
  entries: ListEntry[];
  empty: string;
  hint?: string;
  autoFocus?: boolean;
  // Without the description of the active entry.
  brief?: boolean;
  // Entries are dragged to the canvas.
  draggable?: boolean;
  onChoose: (entry: ListEntry) => void;
  // The entry that Enter would choose.
  onLook?: (entry: ListEntry | null) => void;
  onCancel?: () => void;
};

export function EntryList(props: Props) {
  const { label, placeholder, entries, empty, hint, autoFocus, brief, draggable = false } = props;
  const { onChoose, onLook, onCancel } = props;
  const [text, setText] = useState("");
  const [wished, setWished] = useState<string | null>(null);
  const { found, best } = useMemo(() => search(text, entries), [text, entries]);
  const active = found.find((entry) => entry.id === wished && entry.why === undefined) ?? best;
  const list = useId();
  useEffect(() => onLook?.(active), [active, onLook]);
  // the same entry does not scroll again when the list is made again
  const shown = active === null ? "" : optionId(list, active);
  useEffect(() => {
    document.getElementById(shown)?.scrollIntoView({ block: "nearest" });
  }, [shown]);

  const onKey = (event: KeyboardEvent) => {
    const able = found.filter((entry) => entry.why === undefined);
    const at = able.findIndex((entry) => entry.id === active?.id);
    const step = STEPS[event.key];
    if (step !== undefined && able.length > 0) {
      const next = Math.abs(step) === 1 ? (at + step + able.length) % able.length : at + step;
      setWished(able[Math.min(able.length - 1, Math.max(0, next))]?.id ?? null);
    } else if (event.key === "Enter" && active !== null) {
      onChoose(active);
    } else if (onCancel !== undefined && (event.key === "Escape" || event.key === "Tab")) {
      onCancel();
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  };

  return (
    <>
      <TextInput
        autoFocus={autoFocus}
        size="sm"
        role="combobox"
        aria-label={label}
        aria-expanded
        aria-controls={list}
        aria-activedescendant={active === null ? undefined : optionId(list, active)}
        aria-autocomplete="list"
        placeholder={placeholder}
        leftSection={<IconSearch size={15} aria-hidden />}
        value={text}
        onChange={(event) => {
          setText(event.currentTarget.value);
          setWished(null);
        }}
        onKeyDown={onKey}
      />
      {hint !== undefined && <p className="dim small chooser-hint">{hint}</p>}
      {found.length === 0 && <p className="dim chooser-empty">{empty}</p>}
      <div className="chooser-list" role="listbox" id={list} aria-label={label} tabIndex={-1}>
        {grouped(found, ({ family }) => family).map(([family, members]) => (
          <div role="group" aria-label={family} key={family}>
            <div className="dim chooser-family" aria-hidden>
              {family}
            </div>
            {members.map((entry) => (
              <EntryLine
                key={entry.id}
                id={optionId(list, entry)}
                entry={entry}
                active={entry.id === active?.id}
                draggable={draggable}
                onLook={() => setWished(entry.id)}
                onChoose={() => entry.why === undefined && onChoose(entry)}
              />
            ))}
          </div>
        ))}
      </div>
      {!brief && active?.kind !== undefined && <Description kind={active.kind} />}
      {!brief && active?.template !== undefined && <TemplateDescription template={active.template} />}
    </>
  );
}

const STEPS: Partial<Record<string, number>> = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8 };

const optionId = (list: string, entry: ListEntry): string => `${list}-${entry.id.replace(/[^\w-]/g, "_")}`;

type EntryLineProps = {
  id: string;
  entry: ListEntry;
  active: boolean;
  draggable: boolean;
  onLook: () => void;
  onChoose: () => void;
};

// The sketch of a kind or the picture of a template, its title, and why it cannot be chosen, if so.
function EntryLine({ id, entry, active, draggable, onLook, onChoose }: EntryLineProps) {
  const { title, note, why, kind, template } = entry;
  const carried = draggable ? carriedBy(entry) : null;
  return (
    <div
      id={id}
      className="across chooser-entry"
      role="option"
      tabIndex={-1}
      aria-selected={active}
      aria-disabled={why !== undefined}
      title={why}
      draggable={carried !== null}
      onDragStart={(event) => {
        const now = carriedBy(entry); // its values follow from the document as it is now
        return now !== null && carry(event.dataTransfer, now);
      }}
      onPointerMove={() => !active && why === undefined && onLook()}
      // the text field keeps the focus
      onPointerDown={(event) => carried === null && event.preventDefault()}
      onClick={onChoose}
      onKeyDown={(event) => event.key === "Enter" && onChoose()}
    >
      {kind !== undefined && <Sketch kind={kind} />}
      {template !== undefined && <TemplatePicture template={template} className="chooser-thumbnail" />}
      <span className="down grow">
        <span className="one-line">{title}</span>
        {why !== undefined && <span className="dim one-line chooser-note">{why}</span>}
      </span>
      {note !== undefined && <span className="dim one-line chooser-note">{note}</span>}
    </div>
  );
}

const LINES = 2;
const MOST = 5;

// What a kind computes, below the list: its equation and the meaning of its parameters.
function Description({ kind }: { kind: Kind }) {
  const meanings = kind.parameters
    .map((form) => form.meaning || form.name.replaceAll("_", " "))
    .filter((meaning, i, all) => all.indexOf(meaning) === i);
  return (
    <div className="chooser-description">
      {kind.equation.slice(0, LINES).map((line) => (
        <div className="chooser-equation" key={line}>
          <Tex source={line} />
        </div>
      ))}
      {meanings.length > 0 && (
        <p className="dim chooser-meanings" title={meanings.join(", ")}>
          {meanings.slice(0, MOST).join(", ")}
          {meanings.length > MOST && ", …"}
        </p>
      )}
    </div>
  );
}

// A model that is added whole: its picture and its first sentence.
function TemplateDescription({ template }: { template: TemplateView }) {
  return (
    <div className="chooser-description across">
      <TemplatePicture key={template.name} template={template} className="chooser-picture" />
      <p className="dim grow chooser-meanings">{template.sentence}</p>
    </div>
  );
}
