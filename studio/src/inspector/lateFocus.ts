// The first field of a small form that a menu opens. A menu gives the focus back when it closes; the field
// takes it after that.

import { useEffect, useRef } from "react";

const AFTER_MENU_MS = 40;

export function useLateFocus() {
  const field = useRef<HTMLInputElement>(null);
  useEffect(() => {
    const timer = setTimeout(() => field.current?.focus(), AFTER_MENU_MS);
    return () => clearTimeout(timer);
  }, []);
  return field;
}
