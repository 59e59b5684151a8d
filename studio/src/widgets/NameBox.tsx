// A text field with the names that are valid; another name can be typed.

import { Autocomplete } from "@mantine/core";
import { useRef, useState } from "react";

type NameBoxProps = {
  label: string;
  value: string;
  names: string[];
  placeholder?: string;
  onCommit: (value: string) => unknown;
};

export function NameBox({ label, value, names, placeholder = "choose or type", onCommit }: NameBoxProps) {
  const [draft, setDraft] = useState<string | null>(null);
  // The list writes a chosen name into the field as well, which is no draft.
  const chosen = useRef(false);
  const choose = (text: string) => {
    chosen.current = true;
    queueMicrotask(() => (chosen.current = false));
    take(text);
  };
  const take = (text: string) => {
    setDraft(null);
    if (text !== value) {
      void onCommit(text);
    }
  };
  return (
    <Autocomplete
      className="grow"
      aria-label={label}
      title={value}
      data={names}
      value={draft ?? value}
      placeholder={placeholder}
      limit={60}
      maxDropdownHeight={220}
      autoComplete="off"
      spellCheck={false}
      // all names are listed until one is typed
      filter={draft === null ? ({ options }) => options : undefined}
      onChange={(text) => !chosen.current && setDraft(text)}
      onOptionSubmit={choose}
      onKeyDown={(event) => {
        if (event.key === "Enter" && draft !== null && !event.defaultPrevented) {
          take(draft);
        } else if (event.key === "Escape") {
          setDraft(null);
        }
      }}
      onBlur={() => draft !== null && take(draft)}
    />
  );
}
