// Which element the pointer rests on, and its position on the screen.

import { create } from "zustand";

export type Target = { element: string; left: number; top: number; width: number; height: number };

type Hover = {
  target: Target | null;
  enter: (element: string, at: Element) => void;
  // The card stays for a moment, so that the pointer can go to it.
  leave: () => void;
  stay: () => void;
  close: () => void;
};

const OPEN_MS = 300;
const CLOSE_MS = 120;

let timer = 0;

export const useHover = create<Hover>((set) => {
  const later = (ms: number, target: () => Target | null) => {
    window.clearTimeout(timer);
    timer = window.setTimeout(() => set({ target: target() }), ms);
  };
  return {
    target: null,
    enter: (element, at) =>
      later(OPEN_MS, () => {
        const { left, top, width, height } = at.getBoundingClientRect();
        return at.isConnected ? { element, left, top, width, height } : null;
      }),
    leave: () => later(CLOSE_MS, () => null),
    stay: () => window.clearTimeout(timer),
    close: () => {
      window.clearTimeout(timer);
      set({ target: null });
    },
  };
});
