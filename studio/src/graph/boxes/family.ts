// The family of an element: what it does in an architecture. It follows from what its kind declares (room,
// ports, levels of activation), never from its name.

import type { ElementView, Kind } from "../../protocol";

export type ElementFamily = "source" | "activation" | "coupling" | "other";

export const FAMILIES: Record<ElementFamily, string> = {
  source: "Source: it has no input",
  activation: "Activation with a threshold or a resting level",
  coupling: "Coupling",
  other: "Another element with an input",
};

export function elementFamily(element: Pick<ElementView, "inputs">, kind: Kind | undefined): ElementFamily {
  if (kind?.room === "couplings") {
    return "coupling";
  }
  if (element.inputs.length === 0) {
    return "source";
  }
  return Object.keys(kind?.levels ?? {}).length > 0 ? "activation" : "other";
}
