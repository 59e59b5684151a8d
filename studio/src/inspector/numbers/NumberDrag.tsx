// A number that is dragged sideways; a click on it types.

import { type PointerEvent, type ReactNode, useRef } from "react";

import { useOffline } from "../../connection/NeedsServer";
import { dragged, finer, type SliderRange, snapped } from "./sliderRange";

type NumberDragProps = {
  value: number | null;
  range: SliderRange;
  onMove: (value: number) => void;
  onEnd: () => void;
  children: ReactNode;
};

// A press that moves less is a click.
const CLICK_PX = 3;

const isFocused = (target: EventTarget): boolean => target === document.activeElement;

export function NumberDrag({ value, range, onMove, onEnd, children }: NumberDragProps) {
  const offline = useOffline();
  // The place of the pointer, and the number there before it is rounded.
  const press = useRef<{ x: number; at: number; moving: boolean } | null>(null);

  const onPointerDown = ({ button, clientX, currentTarget, pointerId, target }: PointerEvent) => {
    if (button === 0 && value !== null && !offline && !isFocused(target)) {
      currentTarget.setPointerCapture(pointerId);
      press.current = { x: clientX, at: value, moving: false };
    }
  };
  const onPointerMove = ({ clientX, shiftKey }: PointerEvent) => {
    const before = press.current;
    if (before === null || (!before.moving && Math.abs(clientX - before.x) <= CLICK_PX)) {
      return;
    }
    const at = dragged(before.at, clientX - before.x, shiftKey, range);
    press.current = { x: clientX, at, moving: true };
    onMove(snapped(at, shiftKey ? finer(range) : range));
  };
  const onPointerEnd = ({ currentTarget, type }: PointerEvent) => {
    if (press.current?.moving) {
      onEnd();
    } else if (press.current !== null && type === "pointerup") {
      currentTarget.querySelector("input")?.focus();
    }
    press.current = null;
  };
  return (
    <div
      className={value === null ? undefined : "number-drag"}
      onPointerDown={onPointerDown}
      onPointerMove={onPointerMove}
      onPointerUp={onPointerEnd}
      onPointerCancel={onPointerEnd}
      onMouseDown={(event) => press.current !== null && event.preventDefault()}
    >
      {children}
    </div>
  );
}
