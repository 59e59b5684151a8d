// Signs of weights: excitation, inhibition, or both.

import type { ElementView } from "../protocol";

export type Sign = ElementView["effect"];

// The sign of a product of weights.
export function product(one: Sign, other: Sign): Sign {
  return one === "±" || other === "±" ? "±" : one === other ? "+" : "-";
}

// The sign of weights side by side.
export function together(one: Sign, other: Sign): Sign {
  return one === other ? one : "±";
}

const WORDS: Record<Sign, string> = { "+": "", "-": ", inhibition", "±": ", excitation and inhibition" };

export function signText(sign: Sign): string {
  return WORDS[sign];
}
