// Where the tour is: it reads the same messages as the page, and moves on when a step was done.

import { create } from "zustand";

import { leave } from "../files/flows";
import { type Studio, useStudio } from "../server/store";
import { STEPS } from "./steps";

type Tour = {
  // The step shown; null: there is no tour.
  step: number | null;
  done: boolean;
  // What the server had said when the step began.
  before: Studio | null;
};

export const useTour = create<Tour>(() => ({ step: null, done: false, before: null }));

const EXAMPLE = "selection";

// Open the example of the tour, and begin.
export async function startTour(): Promise<void> {
  if (await leave({ type: "open_example", name: EXAMPLE })) {
    goTo(0);
  }
}

export function goTo(step: number): void {
  useTour.setState(
    step < STEPS.length
      ? { step, done: false, before: useStudio.getState() }
      : { step: null, done: false, before: null },
  );
}

export function endTour(): void {
  goTo(STEPS.length);
}

// Mark the step as done if it was; the tour ends with its document.
export function follow(now: Studio): void {
  const { step, done, before } = useTour.getState();
  if (step === null || before === null) {
    return;
  }
  // the example may arrive after the tour has begun
  if (before.session !== now.session) {
    if (step > 0) {
      endTour();
      return;
    }
    useTour.setState({ before: now });
  } else if (!done && STEPS[step]?.done(now, before) === true) {
    useTour.setState({ done: true });
  }
}
