// What is selected: groups, and the elements outside of these.

import { useStudio } from "../server/store";
import { usePicked } from "./picked";
import { pathOf } from "./placing";

export type Selection = { elements: string[]; groups: string[][] };

export function chosen(): Selection {
  const { selected, elements, document } = useStudio.getState();
  const groups = usePicked.getState().groups.map((key) => (document === null ? [] : pathOf(key, document)));
  const within = (group: string[]) =>
    groups.some((outer) => outer.length <= group.length && outer.every((name, i) => group[i] === name));
  return {
    elements: selected.filter((id) => !within(elements.get(id)?.group ?? [])),
    groups: groups.filter((path) => path.length > 0),
  };
}
