// Duration of automatic movements of the canvas, in milliseconds; 0 for users who set their system to less
// motion.
export function glide(ms: number): number {
  return matchMedia("(prefers-reduced-motion: reduce)").matches ? 0 : ms;
}
