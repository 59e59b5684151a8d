// Pinned parameters: the rows of the panel of sliders, as they are kept in the document's layout.

import type { LayoutView, PinView } from "../protocol";
import { useStudio } from "../server/store";

const NONE: PinView[] = [];

export const usePins = (): PinView[] => useStudio(({ document }) => document?.layout.pins ?? NONE);

const MOST_IN_BOX = 2;

export function isAt(pin: PinView, element: string, parameter: string): boolean {
  return pin.element === element && pin.parameter === parameter;
}

// The sliders in the box of an element: the first ones of its pins. Switches are in the panel alone.
export function boxPins(layout: LayoutView | undefined, element: string): PinView[] {
  return (layout?.pins ?? NONE)
    .filter((pin) => pin.element === element && pin.switch !== true)
    .slice(0, MOST_IN_BOX);
}

export function withPin(pins: PinView[], element: string, parameter: string): PinView[] {
  return pins.some((pin) => isAt(pin, element, parameter)) ? pins : [...pins, { element, parameter }];
}

export function withoutPin(pins: PinView[], element: string, parameter: string): PinView[] {
  return pins.filter((pin) => !isAt(pin, element, parameter));
}

// The values of a switch: off and on.
export function endsOf({ lower = 0, upper = 1 }: PinView): [number, number] {
  return [lower, upper];
}

// Sets the range, label or form of one pin; undefined removes it.
export function changedPin(
  pins: PinView[],
  pin: PinView,
  change: Partial<Pick<PinView, "lower" | "upper" | "label" | "switch">>,
): PinView[] {
  return pins.map((p) => (isAt(p, pin.element, pin.parameter) ? { ...p, ...change } : p));
}
