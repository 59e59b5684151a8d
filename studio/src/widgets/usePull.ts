// A number that is pulled sideways by the pointer; a press that moves less than a few pixels is a click.

import { type PointerEvent, useRef } from "react";

type PullProps = {
  // The number at a press; null: this press pulls nothing.
  begin: (event: PointerEvent) => number | null;
  // Whether the number can be changed; where it cannot, each press is a click.
  isFree: () => boolean;
  // The number after `pixels` more, before it is rounded.
  pulled: (value: number, pixels: number, event: PointerEvent) => number;
  move: (value: number, event: PointerEvent) => void;
  end: () => void;
  click: (event: PointerEvent) => void;
};

// A press that moves less is a click.
const CLICK_PX = 3;

export function usePull({ begin, isFree, pulled, move, end, click }: PullProps) {
  const press = useRef<{ x: number; at: number; moving: boolean } | null>(null);
  const release = (event: PointerEvent) => {
    const last = press.current;
    press.current = null;
    if (last?.moving) {
      end();
    } else if (last !== null && event.type === "pointerup") {
      click(event);
    }
  };
  return {
    isPressed: () => press.current !== null,
    handlers: {
      onPointerDown: (event: PointerEvent) => {
        const at = event.button === 0 ? begin(event) : null;
        if (at !== null) {
          event.currentTarget.setPointerCapture(event.pointerId);
          press.current = { x: event.clientX, at, moving: false };
        }
      },
      onPointerMove: (event: PointerEvent) => {
        const before = press.current;
        if (before === null || !isFree()) {
          return;
        }
        if (!before.moving && Math.abs(event.clientX - before.x) <= CLICK_PX) {
          return;
        }
        const at = pulled(before.at, event.clientX - before.x, event);
        press.current = { x: event.clientX, at, moving: true };
        move(at, event);
      },
      onPointerUp: release,
      onPointerCancel: release,
    },
  };
}
