// The name that is edited in its place.

import type { Rect } from "../model/rects";
import { keyOf } from "../architecture/tree";
import { request } from "../server/socket";
import { useStudio } from "../server/store";
import { pageStore } from "../state/pageStore";
import { isEditable } from "../state/editable";
import { pickGroup, usePicked } from "./picked";
import { pathOf } from "./placing";
import { drawnNode } from "./stage";

export type Renaming = { element: string; group: string[]; name: string; at: Rect };

export const useRenaming = pageStore<{ renaming: Renaming | null }>(() => ({ renaming: null }));

const LEAST_WIDTH = 150;

// Edit the name of the selected element or group.
export function renameSelected(): void {
  const { selected, elements, document } = useStudio.getState();
  const [key] = usePicked.getState().groups;
  if (document === null || !isEditable()) {
    return;
  }
  const group = key === undefined ? [] : pathOf(key, document);
  const element =
    group.length === 0 && selected.length === 1 ? elements.get(selected[0] as string) : undefined;
  const node = group.length > 0 ? `group:${key}` : (element?.id ?? "");
  const at = placeOf(node);
  if (node === "" || at === null) {
    useStudio.getState().notify({ what: "Select one element or group to rename it." }, "info");
    return;
  }
  const name = group.at(-1) ?? element?.name ?? "";
  useRenaming.setState({ renaming: { element: element?.id ?? "", group, name, at } });
}

export async function rename({ element, group, name: before }: Renaming, name: string): Promise<void> {
  useRenaming.setState({ renaming: null });
  if (name.trim() !== "" && name !== before) {
    await request({ type: "rename", element, group, name: name.trim() });
    if (group.length > 0) {
      pickGroup(keyOf([...group.slice(0, -1), name.trim()]), false);
    }
  }
}

// Where the name is written on the screen.
function placeOf(node: string): Rect | null {
  const found = drawnNode(node);
  const words = found?.querySelector(".graph-box-name, .graph-frame-title .one-line") ?? found;
  const rect = words?.getBoundingClientRect();
  return rect === undefined
    ? null
    : { x: rect.x, y: rect.y, width: Math.max(rect.width, LEAST_WIDTH), height: rect.height };
}
