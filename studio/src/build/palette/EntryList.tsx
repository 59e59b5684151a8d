// A list with a search: typed words find an entry, the arrow keys move, Enter or a click chooses.

import { TextInput } from "@mantine/core";
import { IconSearch } from "@tabler/icons-react";
import { type KeyboardEvent, useEffect, useId, useMemo, useState } from "react";

import "./chooser.css";
import { Description, TemplateDescription } from "./Description";
import { type ListEntry, search } from "./entries";
import { grouped } from "../../values";
import { EntryLine } from "./EntryLine";

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

export function EntryList({
  label,
  placeholder,
  entries,
  empty,
  hint,
  autoFocus = false,
  brief = false,
  draggable = false,
  onChoose,
  onLook,
  onCancel,
}: Props) {
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
