// What a selector returns, the same object as long as it is equal: the clock brings new objects with the same
// content many times a second.

import { useRef } from "react";
import { same } from "../model/part";
import { type Studio, useStudio } from "../server/store";

export function useSame<T>(select: (state: Studio) => T): T {
  const last = useRef<{ value: T } | null>(null);
  return useStudio((state) => {
    const value = select(state);
    if (last.current === null || !same(last.current.value, value)) {
      last.current = { value };
    }
    return last.current.value;
  });
}
