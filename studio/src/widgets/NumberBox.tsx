// A number field: Enter or leaving the field commits it, Escape resets it, arrow keys step what is in it
// (with Shift ten steps).

import { TextInput } from "@mantine/core";
import { type KeyboardEvent, useEffect, useRef, useState } from "react";

import type { ListedProblem } from "../protocol";
import { arrowStep, type Limits, numberText, typedNumber, wrongWith } from "../model/number";

export type NumberBoxProps = Limits & {
  label: string;
  // Whether the label stands above the field, or somewhere else.
  labelled?: boolean;
  description?: string;
  value: number | null;
  unit?: string;
  placeholder?: string;
  rejected: boolean;
  disabled?: boolean;
  onCommit: (value: number | null) => Promise<boolean>;
  // Sends a step at once.
  onStep?: (direction: 1 | -1, coarse: boolean) => void;
  onForget: () => void;
  onComplain: (problem: ListedProblem) => void;
  onLeave?: () => void;
};

// How long the problem of a field that was left is shown.
const READING_MS = 6000;

// A unit is shown inside the field if there is space.
const MOST_UNIT = 5;

export function NumberBox(props: NumberBoxProps) {
  const { label, labelled = false, description, value, unit = "", placeholder, rejected, disabled } = props;
  const { onCommit, onStep, onComplain, onLeave } = props;
  const later = useRef<ReturnType<typeof setTimeout> | undefined>(undefined);
  useEffect(() => () => clearTimeout(later.current), []);
  const onForget = () => {
    clearTimeout(later.current);
    props.onForget();
  };
  const [draft, setDraft] = useState<string | null>(null);
  const shown = draft ?? (value === null ? "" : props.whole ? String(value) : numberText(value));
  const inside = unit.length <= MOST_UNIT && shown !== "" ? unit : "";

  const take = async (text: string): Promise<boolean> => {
    const what = wrongWith(text, props);
    if (what !== null) {
      onComplain({ what });
      return false;
    }
    const number = typedNumber(text);
    return number === value || (await onCommit(number));
  };
  const onKeyDown = async (event: KeyboardEvent<HTMLInputElement>) => {
    if (event.key === "Enter" && draft !== null) {
      if (await take(draft)) {
        // what was typed since then stays
        setDraft((now) => (now === draft ? null : now));
      }
    } else if (event.key === "Escape") {
      setDraft(null);
      onForget();
    } else if (event.key === "ArrowUp" || event.key === "ArrowDown") {
      event.preventDefault();
      step(event.key === "ArrowUp" ? 1 : -1, event.shiftKey);
    }
  };
  const step = (direction: 1 | -1, coarse: boolean) => {
    const from = draft === null ? value : typedNumber(draft);
    if (onStep === undefined && from === null) {
      return;
    }
    onForget();
    setDraft(
      onStep === undefined && from !== null ? String(arrowStep(from, direction, coarse, props)) : null,
    );
    onStep?.(direction, coarse);
  };
  const onBlur = () => {
    if (draft !== null && !rejected) {
      void take(draft);
    } else if (draft !== null) {
      onForget();
    }
    // The old value is shown again; the error of the refused one stays for a while.
    later.current = setTimeout(onForget, READING_MS);
    setDraft(null);
    onLeave?.();
  };

  return (
    <TextInput
      className="number-box"
      size="xs"
      label={labelled ? label : undefined}
      aria-label={labelled ? undefined : label}
      description={description}
      title={unit === "" ? undefined : unit}
      value={shown}
      placeholder={placeholder}
      error={rejected && draft !== null}
      disabled={disabled}
      inputMode="decimal"
      autoComplete="off"
      spellCheck={false}
      rightSection={inside === "" ? undefined : <span className="number-unit">{inside}</span>}
      rightSectionWidth={inside === "" ? undefined : 13 + 6.5 * inside.length}
      rightSectionPointerEvents="none"
      onFocus={(event) => {
        event.currentTarget.select();
        onForget();
      }}
      onChange={(event) => {
        setDraft(event.currentTarget.value);
        onForget();
      }}
      onKeyDown={(event) => void onKeyDown(event)}
      onBlur={onBlur}
    />
  );
}
