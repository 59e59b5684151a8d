// How long the canvas takes where it moves by itself, in milliseconds: no time for those who asked their
// system for less motion.
export function glide(ms: number): number {
  return matchMedia("(prefers-reduced-motion: reduce)").matches ? 0 : ms;
}
