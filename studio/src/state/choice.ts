// The one open list of things to choose from: the palette, the targets of a connection, all commands.

import { create } from "zustand";

import type { Point } from "../model/rects";
import type { ListEntry } from "../model/entries";

export type Choice = {
  // What is chosen, as the name of the list.
  label: string;
  placeholder: string;
  // A position on the screen; null: the upper middle.
  at: Point | null;
  entries: ListEntry[];
  // Where nothing is found.
  empty: string;
  // A sentence above the list.
  hint?: string;
  // The entry that Enter would choose.
  onLook?: (entry: ListEntry | null) => void;
  // However the list is closed.
  onClose?: () => void;
};

type Chooser = {
  choice: Choice | null;
  // Counts the lists that were opened.
  number: number;
  open: (choice: Choice) => void;
  close: () => void;
};

export const useChooser = create<Chooser>((set, get) => ({
  choice: null,
  number: 0,
  open: (choice) => {
    get().close();
    set({ choice, number: get().number + 1 });
  },
  close: () => {
    const { choice } = get();
    set({ choice: null });
    choice?.onClose?.();
  },
}));
