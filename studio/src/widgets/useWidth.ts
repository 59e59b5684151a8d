// The width of an element, as it is drawn.

import { type RefObject, useEffect, useState } from "react";

export function useWidth(around: RefObject<HTMLElement | null>): number {
  const [width, setWidth] = useState(0);
  useEffect(() => {
    const element = around.current;
    const observer = new ResizeObserver(() => setWidth(element?.offsetWidth ?? 0));
    if (element !== null) {
      observer.observe(element);
    }
    return () => observer.disconnect();
  }, [around]);
  return width;
}
