// How plots look on the page.

import type { Ink } from "../draw/ink";
import { shade } from "../model/colors";

export function pageInk(small = false): Ink {
  const style = getComputedStyle(document.documentElement);
  const variable = (name: string) => style.getPropertyValue(name).trim();
  return {
    shade: shade(),
    text: variable("--text"),
    dim: variable("--dim"),
    grid: variable("--grid"),
    ground: variable("--panel"),
    unit: 1,
    small,
  };
}
