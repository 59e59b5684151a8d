// A strength on a connection: dragged, typed after a click, or changed by keys.

import { type KeyboardEvent, useEffect, useRef, useState } from "react";
import { isEditable } from "../../state/editable";
import { useStudio } from "../../server/store";
import { typedNumber, wrongWith } from "../../model/number";
import { usePull } from "../../widgets/usePull";
import type { Setting } from "../../actions/setting";
import { short } from "../../model/facts";
import { dragged, pressed, stepped } from "../../actions/strength";

type StrengthControlProps = { label: string; setting: Setting<number>; onClick?: () => void };

export function StrengthControl({ label, setting, onClick }: StrengthControlProps) {
  const { value, problem, commit, move, end, nudge } = setting;
  const [draft, setDraft] = useState<string | null>(null);
  const number = useRef<HTMLDivElement>(null);
  const field = useRef<HTMLInputElement>(null);
  const isTyping = draft !== null;
  // A key that ends the typing leaves the focus here; a press elsewhere takes it there.
  const isEndedByKey = useRef(false);
  useEffect(() => {
    if (isTyping) {
      field.current?.focus();
    } else if (isEndedByKey.current) {
      number.current?.focus();
    }
    isEndedByKey.current = false;
  }, [isTyping]);

  const take = (text: string) => {
    const what = wrongWith(text, {});
    const typed = typedNumber(text);
    setDraft(null);
    if (what !== null) {
      useStudio.getState().notify({ where: label, what });
    } else if (typed !== null && typed !== value) {
      void commit(typed);
    }
  };
  const typing = () => isEditable() && setDraft(String(value));
  const { handlers } = usePull({
    begin: () => value,
    isFree: isEditable,
    pulled: dragged,
    move: (at, event) => move(stepped(at, event)),
    end,
    click: () => {
      onClick?.();
      typing();
    },
  });
  if (draft !== null) {
    return (
      <input
        className="graph-strength-typed numbers nodrag nopan"
        aria-label={label}
        inputMode="decimal"
        autoComplete="off"
        ref={field}
        value={draft}
        onFocus={(event) => event.currentTarget.select()}
        onChange={(event) => setDraft(event.currentTarget.value)}
        onBlur={() => take(draft)}
        onKeyDown={(event) => {
          event.stopPropagation();
          isEndedByKey.current = event.key === "Enter" || event.key === "Escape";
          if (event.key === "Enter") {
            take(draft);
          } else if (event.key === "Escape") {
            setDraft(null);
          }
        }}
      />
    );
  }
  const onKeyDown = (event: KeyboardEvent) => {
    const next = pressed(value, event.key);
    if (event.ctrlKey || event.metaKey || event.altKey || (next === null && event.key !== "Enter")) {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
    if (next === null) {
      typing();
    } else if (isEditable()) {
      nudge(next);
    }
  };
  return (
    <div
      ref={number}
      className="graph-strength numbers nodrag nopan"
      role="spinbutton"
      tabIndex={0}
      aria-label={label}
      aria-valuenow={value}
      title={problem?.what ?? label}
      {...handlers}
      onKeyDown={onKeyDown}
    >
      {short(value)}
    </div>
  );
}
