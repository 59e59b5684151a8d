// The floor of the world as a view shows it: where a pixel of the page lies on it.

import type { PlanPoint } from "./planFrame";

export type Ground = {
  // The place on the floor, within the border, under a pixel of the page; null: outside of the view.
  at: (clientX: number, clientY: number) => PlanPoint | null;
  // Pixels of a unit of the world, there.
  scale: number;
};
