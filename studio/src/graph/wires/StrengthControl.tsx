// A strength on a connection: dragged, typed after a click, or changed by keys.

import { type KeyboardEvent, type PointerEvent, useEffect, useRef, useState } from "react";
import { isEditable } from "../../build/editable";
import { useStudio } from "../../store";
import { typedNumber, wrongWith } from "../../widgets/number";
import type { Setting } from "../../inspector/parameters/setting";
import { short } from "../boxes/facts";
import { dragged, pressed, stepped } from "./strength";

type StrengthControlProps = { label: string; setting: Setting<number>; onClick?: () => void };

// A pointer that moves less is a click.
const CLICK = 3;

type Drag = { x: number; from: number; raw: number; value: number | null };

export function StrengthControl({ label, setting, onClick }: StrengthControlProps) {
  const { value, problem, commit, move, end, nudge } = setting;
  const [draft, setDraft] = useState<string | null>(null);
  const drag = useRef<Drag | null>(null);
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
  const typing = () => isEditable() && setDraft(String(value));
  const onPointerMove = (event: PointerEvent) => {
    const going = drag.current;
    if (going === null || !isEditable()) {
      return;
    }
    going.raw = dragged(going.raw, event.clientX - going.x, event);
    going.x = event.clientX;
    if (going.value === null && Math.abs(event.clientX - going.from) < CLICK) {
      return;
    }
    going.value = stepped(going.raw, event);
    move(going.value);
  };
  const release = (isClick: boolean) => {
    const last = drag.current;
    drag.current = null;
    if (last !== null && last.value !== null) {
      end();
    } else if (last !== null && isClick) {
      onClick?.();
      typing();
    }
  };
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
      onPointerDown={(event) => {
        if (event.button === 0) {
          event.currentTarget.setPointerCapture(event.pointerId);
          drag.current = { x: event.clientX, from: event.clientX, raw: value, value: null };
        }
      }}
      onPointerMove={onPointerMove}
      onPointerUp={() => release(true)}
      onPointerCancel={() => release(false)}
      onKeyDown={onKeyDown}
    >
      {short(value)}
    </div>
  );
}
