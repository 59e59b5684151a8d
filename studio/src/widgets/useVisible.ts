// Whether an element is in view; `first` until that is known.

import { type RefObject, useEffect, useState } from "react";

export function useVisible(around: RefObject<HTMLElement | null>, first: boolean): boolean {
  const [visible, setVisible] = useState(first);
  useEffect(() => {
    const observer = new IntersectionObserver((seen) => setVisible(seen.at(-1)?.isIntersecting ?? first));
    if (around.current !== null) {
      observer.observe(around.current);
    }
    return () => observer.disconnect();
  }, [around, first]);
  return visible;
}
