// A text field: Enter or leaving the field commits it, Escape resets it.

import { TextInput } from "@mantine/core";
import { useState, type KeyboardEvent } from "react";

type TextBoxProps = {
  label: string;
  value: string;
  placeholder?: string;
  rejected?: boolean;
  autoFocus?: boolean;
  onCommit: (value: string) => Promise<boolean>;
  onForget?: () => void;
};

export function TextBox(props: TextBoxProps) {
  const { label, value, placeholder, rejected = false, autoFocus = false, onCommit, onForget } = props;
  const [draft, setDraft] = useState<string | null>(null);
  const take = async (text: string) => text === value || (await onCommit(text));
  const onKeyDown = async (event: KeyboardEvent) => {
    if (event.key === "Enter" && draft !== null) {
      event.preventDefault();
      if (await take(draft)) {
        // what was typed since then stays
        setDraft((now) => (now === draft ? null : now));
      }
    } else if (event.key === "Escape") {
      setDraft(null);
      onForget?.();
    }
  };
  const onBlur = () => {
    if (draft !== null && !rejected) {
      void take(draft);
    } else if (draft !== null) {
      onForget?.();
    }
    setDraft(null);
  };
  return (
    <TextInput
      className="grow"
      aria-label={label}
      title={value}
      placeholder={placeholder}
      value={draft ?? value}
      error={rejected && draft !== null}
      autoFocus={autoFocus}
      onChange={(event) => {
        setDraft(event.currentTarget.value);
        onForget?.();
      }}
      onKeyDown={(event) => void onKeyDown(event)}
      onBlur={onBlur}
    />
  );
}
