// The list of a menu. It takes the focus when it opens, also where its first entry is disabled: without
// a focus inside, no key reaches it.

import { Menu } from "@mantine/core";
import type { ReactNode } from "react";

function takeFocus(list: HTMLElement | null): void {
  setTimeout(() => {
    if (list !== null && !list.contains(document.activeElement))
      (list.querySelector<HTMLElement>("[data-menu-item]:not(:disabled)") ?? list).focus();
  });
}

export function MenuList({ children }: { children: ReactNode }) {
  return <Menu.Dropdown ref={takeFocus}>{children}</Menu.Dropdown>;
}
