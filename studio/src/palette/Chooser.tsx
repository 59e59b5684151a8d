// A list to choose from in front of the page, at the pointer.

import { type RefObject, useCallback, useEffect, useLayoutEffect, useRef, useState } from "react";

import { type Choice, useChooser } from "../state/choice";
import { EntryList } from "./EntryList";

const WIDTH = 360;
const MARGIN = 8;

export function Chooser() {
  const choice = useChooser((state) => state.choice);
  const number = useChooser((state) => state.number);
  return choice === null ? null : <Opened choice={choice} key={number} />;
}

function Opened({ choice }: { choice: Choice }) {
  const around = useRef<HTMLDivElement>(null);
  const [before] = useState(() => document.activeElement);
  const place = usePlace(around, choice.at);
  const cancel = useCallback(() => {
    useChooser.getState().close();
    if (before instanceof HTMLElement) {
      before.focus({ preventScroll: true });
    }
  }, [before]);
  useEffect(() => {
    const outside = (event: PointerEvent) => {
      if (around.current !== null && !around.current.contains(event.target as Node)) {
        useChooser.getState().close();
      }
    };
    addEventListener("pointerdown", outside, { capture: true });
    return () => removeEventListener("pointerdown", outside, { capture: true });
  }, []);
  return (
    <div className="chooser down" role="dialog" aria-label={choice.label} ref={around} style={place}>
      <EntryList
        autoFocus
        label={choice.label}
        placeholder={choice.placeholder}
        entries={choice.entries}
        empty={choice.empty}
        hint={choice.hint}
        onLook={choice.onLook}
        onCancel={cancel}
        onChoose={(entry) => {
          useChooser.getState().close();
          entry.run?.();
        }}
      />
    </div>
  );
}

// On the screen: at the pointer, moved so that all of it is visible. It never shrinks, so that nothing moves
// while a word is typed.
function usePlace(around: RefObject<HTMLElement | null>, at: Choice["at"]) {
  const width = Math.min(WIDTH, innerWidth - 2 * MARGIN);
  const wish = at ?? { x: (innerWidth - width) / 2, y: innerHeight / 8 };
  const [height, setHeight] = useState(0);
  useLayoutEffect(() => {
    const measure = () => setHeight((known) => Math.max(known, around.current?.offsetHeight ?? 0));
    measure();
    const observer = new ResizeObserver(measure);
    observer.observe(around.current as HTMLElement);
    return () => observer.disconnect();
  }, [around]);
  return {
    width,
    left: Math.max(MARGIN, Math.min(wish.x, innerWidth - width - MARGIN)),
    top: Math.max(MARGIN, Math.min(wish.y, innerHeight - height - MARGIN)),
  };
}
