// The rectangle of the control that a step uses, as long as it is on the screen.

import { useEffect, useState } from "react";

import { useStudio } from "../server/store";
import { STEPS } from "./steps";

const AROUND = 4;
const EVERY_MS = 150;

export type Outline = {
  style: { left: number; top: number; width: number; height: number };
  // Whether it lies in the right half of the page.
  right: boolean;
};

export function useOutline(step: number): Outline | null {
  const [outline, setOutline] = useState<Outline | null>(null);
  useEffect(() => {
    // controls come, move and go with the document, so that nothing but a look finds where they are
    const look = () => setOutline((known) => same(known, found(STEPS[step]?.mark(useStudio.getState()))));
    look();
    const timer = setInterval(look, EVERY_MS);
    return () => clearInterval(timer);
  }, [step]);
  return outline;
}

function found(selector: string | undefined): Outline | null {
  const box = selector === undefined ? undefined : document.querySelector(selector)?.getBoundingClientRect();
  if (box === undefined || box.width === 0) {
    return null;
  }
  const style = {
    left: box.left - AROUND,
    top: box.top - AROUND,
    width: box.width + 2 * AROUND,
    height: box.height + 2 * AROUND,
  };
  return { style, right: box.left + box.width / 2 > innerWidth / 2 };
}

function same(known: Outline | null, next: Outline | null): Outline | null {
  return JSON.stringify(known) === JSON.stringify(next) ? known : next;
}
