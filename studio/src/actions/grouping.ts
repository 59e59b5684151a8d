// Groups are made of what is selected, and dissolved.

import { keyOf } from "../architecture/tree";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { isEditable } from "../state/editable";
import { pickGroup } from "./picked";
import { chosen } from "./selection";
import { getStage } from "./stage";

const FRAMES = 60;

export async function groupSelected(): Promise<void> {
  const { elements, groups } = chosen();
  if (!isEditable() || elements.length + groups.length === 0) {
    return;
  }
  const { group = [] } = await request({ type: "group", elements, groups, name: "" });
  if (group.length > 0) {
    whenShown(keyOf(group), () => pickGroup(keyOf(group), false));
  }
}

// The selected groups, or else the group around the selected elements.
export async function ungroupSelected(): Promise<void> {
  const { elements, groups } = chosen();
  const around = elements.map((id) => useStudio.getState().elements.get(id)?.group ?? []);
  const all = new Map([...groups, ...around].map((path) => [keyOf(path), path]));
  all.delete("");
  if (!isEditable()) {
    return;
  }
  // the innermost first, so that the paths of the others stay
  for (const group of [...all.values()].sort((a, b) => b.length - a.length)) {
    await request({ type: "ungroup", group });
  }
}

function whenShown(key: string, act: () => void, frames = FRAMES): void {
  if (getStage()?.scene().tree.groups.has(key) === true) {
    act();
  } else if (frames > 0) {
    requestAnimationFrame(() => whenShown(key, act, frames - 1));
  }
}

export function selectAll(): void {
  const tree = getStage()?.scene().tree;
  useStudio.getState().select([...(tree?.home.keys() ?? [])]);
}
