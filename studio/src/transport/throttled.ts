// The store at a calm pace: for read-outs that change with every frame.

import { useEffect, useState } from "react";

import { type Studio, useStudio } from "../store";

// A value of the store, read at once and then at most once in the given time.
export function useThrottled<T>(select: (state: Studio) => T, every = 100): T {
  const [value, setValue] = useState(() => select(useStudio.getState()));
  useEffect(() => {
    let timer: ReturnType<typeof setTimeout> | null = null;
    let last = 0;
    const show = () => {
      timer = null;
      last = performance.now();
      setValue(select(useStudio.getState()));
    };
    show();
    const stop = useStudio.subscribe(() => {
      timer ??= setTimeout(show, Math.max(0, last + every - performance.now()));
    });
    return () => {
      stop();
      if (timer !== null) {
        clearTimeout(timer);
      }
    };
  }, [select, every]);
  return value;
}
