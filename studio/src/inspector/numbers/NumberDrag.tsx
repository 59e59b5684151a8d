// A number that is dragged sideways; a click on it types.

import type { ReactNode } from "react";

import { useOffline } from "../../connection/NeedsServer";
import { usePull } from "../../widgets/usePull";
import { dragged, finer, type SliderRange, snapped } from "./sliderRange";

type NumberDragProps = {
  value: number | null;
  range: SliderRange;
  onMove: (value: number) => void;
  onEnd: () => void;
  children: ReactNode;
};

const isFocused = (target: EventTarget): boolean => target === document.activeElement;

export function NumberDrag({ value, range, onMove, onEnd, children }: NumberDragProps) {
  const offline = useOffline();
  const { isPressed, handlers } = usePull({
    begin: ({ target }) => (offline || isFocused(target) ? null : value),
    isFree: () => true,
    pulled: (at, pixels, { shiftKey }) => dragged(at, pixels, shiftKey, range),
    move: (at, { shiftKey }) => onMove(snapped(at, shiftKey ? finer(range) : range)),
    end: onEnd,
    click: ({ currentTarget }) => currentTarget.querySelector("input")?.focus(),
  });
  return (
    <div
      className={value === null ? undefined : "number-drag"}
      {...handlers}
      onMouseDown={(event) => isPressed() && event.preventDefault()}
    >
      {children}
    </div>
  );
}
