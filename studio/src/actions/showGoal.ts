// Leads to an element or a group on the canvas: the view of the architecture is shown, and folded groups are
// opened.

import { getStage } from "./stage";
import { showView, usePage } from "../state/page";

// An element by its id, or a group by its key on the canvas.
export type CanvasGoal = { element: string } | { group: string };

// A view that was hidden gets its size within some frames; it has it when it keeps one for a few.
const FRAMES = 90;
const STILL = 5;

export function showGoal(goal: CanvasGoal): void {
  onCanvas(() => ("group" in goal ? getStage()?.centerGroup(goal.group) : getStage()?.center(goal.element)));
}

// Do something on the canvas, in the view that has it; the tool in the dock stays.
export function onCanvas(run: () => unknown): void {
  if (usePage.getState().view === "build") {
    run();
    return;
  }
  usePage.setState(({ view, tabs }) => ({ tabs: { ...tabs, build: tabs[view] ?? tabs.build } }));
  showView("build");
  whenStill(run, FRAMES, "", 0);
}

function whenStill(run: () => unknown, frames: number, before: string, still: number): void {
  requestAnimationFrame(() => {
    const { clientWidth: width = 0, clientHeight: height = 0 } = getStage()?.around ?? {};
    const size = width * height > 0 ? `${width} ${height}` : "";
    const now = size !== "" && size === before ? still + 1 : 0;
    if (now >= STILL || frames === 0) {
      run();
    } else {
      whenStill(run, frames - 1, size, now);
    }
  });
}
