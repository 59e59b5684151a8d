// Kinds by family, for the palette. A family follows from the description of a kind, never from its name.

import type { Kind } from "../protocol";

const [DYNAMIC, SOURCES, COUPLINGS, PACKAGES] = [
  "Fields, nodes and memory",
  "Sources and stimuli",
  "Couplings",
  "Of packages",
];
export const ELEMENTS = [DYNAMIC, SOURCES, COUPLINGS, PACKAGES];

const PARTS: Record<string, string> = { kernels: "Kernels", sigmoids: "Sigmoids", windows: "Time windows" };

// The family of a kind; null: a document has no such elements and parts (worlds).
export function familyOf(kind: Kind): string | null {
  const elements = isSource(kind) ? SOURCES : DYNAMIC;
  return { elements, couplings: COUPLINGS, own: PACKAGES, ...PARTS }[kind.room] ?? null;
}

// Whether a kind is a part of elements, such as a kernel.
export const isPart = (kind: Kind): boolean => kind.room in PARTS;

// A source has outputs alone.
export function isSource(kind: Kind): boolean {
  const ports = Object.keys(kind.ports);
  return ports.length > 0 && ports.every((port) => port === "output");
}

// The parameters of a kind that take parts of another kind.
export function takes(kind: Kind | undefined, part: Kind): { name: string; several: boolean }[] {
  return (kind?.parameters ?? [])
    .filter((form) => (form.form === "part" || form.form === "parts") && form.of.includes(part.name))
    .map((form) => ({ name: form.name, several: form.form === "parts" }));
}
