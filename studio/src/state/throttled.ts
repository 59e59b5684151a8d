// Calm paces: for read-outs that change with every frame.

import { useEffect, useState } from "react";

import { type Studio, useStudio } from "../server/store";

// `later` runs a function at once, and then at most once in the given time; `end` cancels what waits.
export function paced(run: () => void, every: number): { later: () => void; end: () => void } {
  let timer: ReturnType<typeof setTimeout> | undefined;
  let last = -Infinity;
  const now = () => {
    timer = undefined;
    last = performance.now();
    run();
  };
  const later = () => {
    timer ??= setTimeout(now, Math.max(0, last + every - performance.now()));
  };
  const end = () => {
    clearTimeout(timer);
    timer = undefined;
  };
  return { later, end };
}

// A value of the store, read at once and then at most once in the given time.
export function useThrottled<T>(select: (state: Studio) => T, every = 100): T {
  const read = () => select(useStudio.getState());
  const [value, setValue] = useState(read);
  useEffect(() => {
    const { later, end } = paced(() => setValue(read), every);
    setValue(read);
    const stop = useStudio.subscribe(later);
    return () => {
      stop();
      end();
    };
  }, [select, every]);
  return value;
}
