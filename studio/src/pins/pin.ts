// Pinned parameters: the rows of the panel of sliders, as they are kept in the document's layout.

import type { DocumentView } from "../protocol";

// `element` is empty for a document parameter. `lower` and `upper` are a chosen range, `label` a custom
// name; `switch` shows a switch between the ends of the range instead of a slider.
export type Pin = {
  element: string;
  parameter: string;
  lower?: number;
  upper?: number;
  label?: string;
  switch?: boolean;
};

type Layout = DocumentView["layout"];

const MOST_IN_BOX = 2;
const NONE: Pin[] = [];
const read = new WeakMap<object, Pin[]>();

// The valid entries of the stored pins; others are omitted, and of equal pins the first one counts.
export function pinsOf(layout: Layout | undefined): Pin[] {
  const kept = layout?.["pins"];
  if (!Array.isArray(kept)) {
    return NONE;
  }
  let pins = read.get(kept);
  if (pins === undefined) {
    pins = (kept as unknown[])
      .flatMap(pinOf)
      .filter((pin, i, all) => all.findIndex((p) => isAt(p, pin.element, pin.parameter)) === i);
    read.set(kept, pins);
  }
  return pins;
}

function pinOf(kept: unknown): Pin[] {
  if (typeof kept !== "object" || kept === null) {
    return [];
  }
  const { element, parameter, lower, upper, label, switch: switched } = kept as Record<string, unknown>;
  if (typeof element !== "string" || typeof parameter !== "string") {
    return [];
  }
  const pin: Pin = { element, parameter };
  if (typeof lower === "number") {
    pin.lower = lower;
  }
  if (typeof upper === "number") {
    pin.upper = upper;
  }
  if (typeof label === "string" && label !== "") {
    pin.label = label;
  }
  if (switched === true) {
    pin.switch = true;
  }
  return [pin];
}

export function isAt(pin: Pin, element: string, parameter: string): boolean {
  return pin.element === element && pin.parameter === parameter;
}

// The sliders in the box of an element: the first ones of its pins. Switches are in the panel alone.
export function boxPins(layout: Layout | undefined, element: string): Pin[] {
  return pinsOf(layout)
    .filter((pin) => pin.element === element && pin.switch !== true)
    .slice(0, MOST_IN_BOX);
}

export function withPin(pins: Pin[], element: string, parameter: string): Pin[] {
  return pins.some((pin) => isAt(pin, element, parameter)) ? pins : [...pins, { element, parameter }];
}

export function withoutPin(pins: Pin[], element: string, parameter: string): Pin[] {
  return pins.filter((pin) => !isAt(pin, element, parameter));
}

// The values of a switch: off and on.
export function endsOf({ lower = 0, upper = 1 }: Pin): [number, number] {
  return [lower, upper];
}

// Sets the range, label or form of one pin; undefined removes it.
export function changedPin(
  pins: Pin[],
  pin: Pin,
  change: Partial<Pick<Pin, "lower" | "upper" | "label" | "switch">>,
): Pin[] {
  return pins.map((p) => (isAt(p, pin.element, pin.parameter) ? (pinOf({ ...p, ...change })[0] ?? p) : p));
}
