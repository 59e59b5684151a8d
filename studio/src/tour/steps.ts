// The steps of the tour: what to do, on which control, and how the document or the run shows that it was
// done.

import type { ElementView } from "../protocol";
import type { Studio } from "../server/store";

export type TourStep = {
  title: string;
  text: string;
  // What is learned from it.
  lesson: string;
  // A CSS selector of the controls that the step uses; the first that is there is outlined.
  mark: (now: Studio) => string;
  // Whether it was done, since the moment at which the step began.
  done: (now: Studio, before: Studio) => boolean;
};

const undone = (state: Studio): number => state.document?.undo ?? 0;
const count = (state: Studio, of: "elements" | "connections"): number => state.document?.[of].length ?? 0;

export const STEPS: readonly TourStep[] = [
  {
    title: "Run the model",
    text: "Press Space, or the green button.",
    lesson:
      "After 100 ms two equal inputs arrive. The field can hold one peak: noise decides which input wins." +
      " Reset (Shift+R) and Play let it decide again.",
    mark: () => '[role="toolbar"] [aria-label="Play"], [role="toolbar"] [aria-label="Pause"]',
    done: ({ clock }) => clock?.running === true,
  },
  {
    title: "Select an element",
    text: "Click the box that the wires lead to.",
    lesson: "The inspector on the right states its equation and has a line for each of its parameters.",
    mark: (now) => selectorOf(central(now)),
    done: (now) => now.selected.some((id) => id === central(now)?.id),
  },
  {
    title: "Find an instability",
    text:
      "Drag the slider of the resting level to the left, until the peak decays, then slowly back to where" +
      " it was.",
    lesson:
      "The peak stayed below the value at which it would form, and does not return at the value at which" +
      " it decayed. This is hysteresis: between the two instabilities the field keeps what it has.",
    mark: () => '[role="slider"][aria-label="resting_level"], .value-slider [role="slider"]',
    done: (now, before) => undone(now) > undone(before),
  },
  {
    title: "Undo",
    text: "Press Ctrl+Z, or the arrow in the header.",
    lesson: "A whole drag is one step. Every edit can be undone, while the model runs.",
    mark: () => '[aria-label="Undo"]',
    done: (now, before) => undone(now) < undone(before),
  },
  {
    title: "Add input by hand",
    text: "Hold the right mouse button in the plot below, at a place without a peak.",
    lesson: "The input lasts as long as you hold the button, and is no part of the document.",
    mark: () => ".plot canvas",
    done: (now, before) => now.clock?.pushing !== "" && before.clock !== now.clock,
  },
  {
    title: "Go back in time",
    text: "Drag the slider of time, at the foot of the page, to the left.",
    lesson:
      "The last 60 s of every run can be seen again, in all plots and boxes. The arrow keys show one frame" +
      " after the other; Live returns to the present.",
    mark: () => '[aria-label="Replay"]',
    done: ({ clock }) => clock?.timeline?.time != null,
  },
  {
    title: "Add an element",
    text:
      "Double-click the ground beside the boxes, or press /. Type the first letters of a kind, and press" +
      " Enter.",
    lesson:
      "The new element works at once: it has the axes of the field. Only kinds that deodar knows are in the" +
      " list, those of installed packages too.",
    mark: () => ".graph",
    done: (now, before) => count(now, "elements") > count(before, "elements"),
  },
  {
    title: "Connect it",
    text: "Drag from the point on the right of its box to the point on the left of another box.",
    lesson: "Ports that fit light up while you drag. The old program runs until the new one is compiled.",
    mark: () => ".graph",
    done: (now, before) => count(now, "connections") > count(before, "connections"),
  },
  {
    title: "Save",
    text: "Press Ctrl+S, and choose a name.",
    lesson: "The file is JSON, and opens in a script too: deodar.load(name). Press ? for all keys.",
    mark: () => '[aria-label="File menu"]',
    done: ({ document }) => document !== null && document.file !== "" && !document.unsaved,
  },
];

// The element with the most connections that lead to it.
export function central({ document }: Studio): ElementView | undefined {
  const arriving = (element: ElementView) =>
    document?.connections.filter(({ target }) => target === element.id).length ?? 0;
  return document?.elements.toSorted((a, b) => arriving(b) - arriving(a))[0];
}

function selectorOf(element: ElementView | undefined): string {
  return element === undefined ? ".graph" : `.react-flow__node[data-id="${CSS.escape(element.id)}"]`;
}
