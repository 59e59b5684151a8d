// Focuses the first field of a small form that a menu opens, after the closed menu has restored the focus.

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
