// Presets that a document keeps in its layout: sets of values, by the menu or switch that they belong to.

import type { DocumentView } from "../protocol";
import { request } from "../socket";
import { useStudio } from "../store";

export type KeptPreset = { name: string; group: string };

export type PresetGroup = { group: string; presets: KeptPreset[] };

const NO_GROUPS: PresetGroup[] = [];
const known = new WeakMap<object, PresetGroup[]>();

// The valid entries of the stored presets by their groups; others are omitted, and of equal names the first
// one counts.
export function presetGroups(layout: DocumentView["layout"] | undefined): PresetGroup[] {
  const kept = layout?.["presets"];
  if (!Array.isArray(kept)) {
    return NO_GROUPS;
  }
  let groups = known.get(kept);
  if (groups === undefined) {
    groups = grouped((kept as unknown[]).flatMap(presetOf));
    known.set(kept, groups);
  }
  return groups;
}

function presetOf(kept: unknown): KeptPreset[] {
  if (typeof kept !== "object" || kept === null) {
    return [];
  }
  const { name, group = "", values } = kept as Record<string, unknown>;
  const valid = typeof name === "string" && name !== "" && typeof group === "string";
  return valid && typeof values === "object" && values !== null ? [{ name, group }] : [];
}

function grouped(presets: KeptPreset[]): PresetGroup[] {
  const groups = new Map<string, PresetGroup>();
  const seen = new Set<string>();
  for (const preset of presets) {
    if (!seen.has(preset.name)) {
      seen.add(preset.name);
      const found = groups.get(preset.group) ?? { group: preset.group, presets: [] };
      groups.set(preset.group, { ...found, presets: [...found.presets, preset] });
    }
  }
  return [...groups.values()];
}

// What is shown of a name inside its group: "place: near" is "near".
export function choiceText({ name, group }: KeptPreset): string {
  const start = `${group}: `;
  return group !== "" && name.startsWith(start) ? name.slice(start.length) : name;
}

// Removes the presets of a group from the document, as one step of undo.
export function removeGroup(group: string): void {
  const kept = useStudio.getState().document?.layout["presets"];
  const rest = (Array.isArray(kept) ? (kept as unknown[]) : []).filter((entry) =>
    presetOf(entry).every((preset) => preset.group !== group),
  );
  void request({ type: "arrange", layout: { presets: rest.length > 0 ? rest : null }, undoable: true });
}
