// Presets that a document keeps in its layout: sets of values, by the menu or switch that they belong to.

import type { KeptPresetView } from "../protocol";
import { request } from "../server/socket";
import { useStudio } from "../server/store";

export type PresetGroup = { group: string; presets: KeptPresetView[] };

// The presets by their groups, in the order of the document.
export function presetGroups(presets: readonly KeptPresetView[]): PresetGroup[] {
  const names = new Set(presets.map(({ group }) => group));
  return [...names].map((group) => ({ group, presets: presets.filter((one) => one.group === group) }));
}

// What is shown of a name inside its group: "place: near" is "near".
export function choiceText({ name, group }: KeptPresetView): string {
  const start = `${group}: `;
  return group !== "" && name.startsWith(start) ? name.slice(start.length) : name;
}

// Removes the presets of a group from the document, as one step of undo.
export function removeGroup(group: string): void {
  const presets = useStudio.getState().document?.layout.presets.filter((one) => one.group !== group);
  void request({ type: "arrange", layout: { presets }, undoable: true });
}
