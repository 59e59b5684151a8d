// A number field: Enter or leaving the field commits it, Escape resets it, arrow keys step (with Shift ten
// steps).

import { TextInput } from "@mantine/core";
import { useState, type KeyboardEvent } from "react";

import type { ListedProblem } from "../../protocol";
import { numberText, typedNumber } from "./number";

export type NumberBoxProps = {
  label: string;
  value: number | null;
  unit?: string;
  // Whether it may be left empty.
  optional?: boolean;
  placeholder?: string;
  rejected: boolean;
  disabled?: boolean;
  onCommit: (value: number | null) => Promise<boolean>;
  onStep?: (direction: 1 | -1, coarse: boolean) => void;
  onForget: () => void;
  onComplain: (problem: ListedProblem) => void;
  onLeave?: () => void;
};

// A unit is shown inside the field if there is space.
const MOST_UNIT = 5;

export function NumberBox(props: NumberBoxProps) {
  const {
    label,
    value,
    unit = "",
    optional = false,
    placeholder,
    rejected,
    disabled,
    onCommit,
    onStep,
    onForget,
    onComplain,
    onLeave,
  } = props;
  const [draft, setDraft] = useState<string | null>(null);
  const inside = unit.length <= MOST_UNIT ? unit : "";

  const take = async (text: string): Promise<boolean> => {
    const number = typedNumber(text);
    if (number === null && !(optional && text.trim() === "")) {
      onComplain({ what: text.trim() === "" ? "needs a number" : `needs a number, not ${text.trim()}` });
      return false;
    }
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
    } else if ((event.key === "ArrowUp" || event.key === "ArrowDown") && onStep !== undefined) {
      event.preventDefault();
      setDraft(null);
      onForget();
      onStep(event.key === "ArrowUp" ? 1 : -1, event.shiftKey);
    }
  };
  const onBlur = () => {
    if (draft !== null && !rejected) {
      void take(draft);
    } else if (draft !== null) {
      onForget();
    }
    setDraft(null);
    onLeave?.();
  };

  return (
    <TextInput
      className="number-box"
      size="xs"
      aria-label={label}
      title={unit === "" ? undefined : unit}
      value={draft ?? (value === null ? "" : numberText(value))}
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
