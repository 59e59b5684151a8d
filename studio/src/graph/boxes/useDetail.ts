// The level of detail of one box.

import { type DetailLevel, useInView, useLook } from "./zoom";

export function useDetail(id: string): DetailLevel {
  const level = useLook((look) => look.level);
  return useInView(({ ids }) => ids.has(id)) ? level : "dot";
}
