// Connections and groups that are selected, beside the elements that the store knows.

import { create } from "zustand";

import { below } from "../architecture/tree";
import { useStudio } from "../server/store";
import { getStage } from "./stage";

type PickedItems = {
  // Ids of the connections on the canvas.
  wires: string[];
  // Keys of groups.
  groups: string[];
  // The connection below an element that is dragged.
  over: string | null;
  // The group that takes what is dragged when it is released; "" is the top level, null: none.
  into: string | null;
};

const NOTHING: PickedItems = { wires: [], groups: [], over: null, into: null };

export const usePicked = create<PickedItems>(() => NOTHING);

// Another selection of elements ends that of groups and connections.
let own = "";
useStudio.subscribe(({ selected, session }, before) => {
  // Nothing of the document before is picked in another one.
  if (session !== before.session) {
    usePicked.setState(NOTHING);
    return;
  }
  const { wires, groups } = usePicked.getState();
  if (selected !== before.selected && wires.length + groups.length > 0 && selected.join() !== own) {
    usePicked.setState({ wires: [], groups: [] });
  }
});

function select(elements: string[]): void {
  own = elements.join();
  useStudio.getState().select(elements);
}

export function pickWire(id: string, several: boolean): void {
  const { wires } = usePicked.getState();
  if (!several) {
    select([]);
  }
  const rest = wires.filter((other) => other !== id);
  usePicked.setState(
    several ? { wires: rest.length < wires.length ? rest : [...wires, id] } : { wires: [id], groups: [] },
  );
}

// The element alone, or added to the selection and taken from it.
export function pickElement(id: string, several: boolean): void {
  const { selected } = useStudio.getState();
  const rest = selected.filter((other) => other !== id);
  useStudio.getState().select(!several ? [id] : rest.length < selected.length ? rest : [...selected, id]);
}

// A group is selected with all its elements.
export function pickGroup(key: string, several: boolean): void {
  const tree = getStage()?.scene().tree;
  const group = tree?.groups.get(key);
  if (tree === undefined || group === undefined) {
    return;
  }
  const inside = new Set(below(group));
  for (const [id, home] of tree.home) {
    if (home === key || home.startsWith(`${key}/`)) {
      inside.add(id);
    }
  }
  const { selected } = useStudio.getState();
  const { groups, wires } = usePicked.getState();
  select(several ? [...new Set([...selected, ...inside])] : [...inside]);
  usePicked.setState(
    several ? { groups: [...new Set([...groups, key])], wires } : { groups: [key], wires: [] },
  );
}
