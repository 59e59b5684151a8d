// Leads to an element on the canvas: the panel of the architecture is shown, folded groups are opened.

import { getStage } from "../build/stage";
import { isShown, openTool } from "../panels/openPlot";

// A panel that was closed gets its size within some frames; it has it when it keeps one for a few.
const FRAMES = 90;
const STILL = 5;

export function showElement(element: string): void {
  if (isShown("graph")) {
    getStage()?.center(element);
    return;
  }
  openTool("graph");
  whenStill(() => getStage()?.center(element), FRAMES, "", 0);
}

function whenStill(run: () => void, frames: number, before: string, still: number): void {
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
