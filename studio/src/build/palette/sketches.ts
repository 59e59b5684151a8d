// The small pictures of kinds, as paths and signs.

export type SketchDrawing = { line?: string; faint?: string; sign?: string };

// A curve over -1 to 1; the values 0 to 1 fill the height.
function curve(value: (x: number) => number): string {
  const points = Array.from({ length: 45 }, (_, i) => {
    const x = -1 + (2 * i) / 44;
    return `${(19 + 17 * x).toFixed(1)},${(21 - 18 * value(x)).toFixed(1)}`;
  });
  return `M${points.join("L")}`;
}

const bell = (x: number, width = 0.3) => Math.exp(-(x * x) / (2 * width * width));
const GROUND = "M2,21H36";
const MIDDLE = "M2,14H36";
// Fixed, so that it looks the same each time.
const RANDOM = [9, 15, 6, 18, 11, 4, 14, 19, 8, 13, 5, 16, 10, 18, 7, 12];
const zigzag = RANDOM.map((y, i) => `${2 + (34 * i) / (RANDOM.length - 1)},${y}`).join("L");

// In the order in which kinds are listed.
export const DRAWN = {
  peak: { line: curve((x) => 0.08 + 0.92 * bell(x, 0.24)), faint: "M2,12H36" },
  trace: {
    line: curve((x) => 0.42 * bell(x + 0.3, 0.24) + 0.3 * bell(x - 0.4, 0.2)),
    faint: curve((x) => bell(x + 0.3, 0.16)),
  },
  winner: {
    line: curve((x) => bell(x, 0.15)),
    faint: curve((x) => 0.4 * bell(x + 0.62, 0.13) + 0.4 * bell(x - 0.62, 0.13)),
  },
  node: { line: "M10,12A9,9 0 1 1 28,12A9,9 0 1 1 10,12", faint: "M2,12H10M28,12H36" },
  bell: { line: curve((x) => bell(x)), faint: GROUND },
  box: { line: "M2,21H12V4H26V21H36", faint: GROUND },
  moving: { line: curve((x) => bell(x + 0.35, 0.25)), faint: "M22,8H34M30,4L34,8L30,12" },
  flat: { line: "M2,9H36", faint: GROUND },
  noise: { line: `M${zigzag}` },
  samples: { line: "M5,21V13M12,21V8M19,21V3M26,21V10M33,21V15", faint: GROUND },
  series: { line: "M2,18L8,15L14,6L20,9L26,4L32,14L36,12", faint: GROUND },
  decay: { line: curve((x) => 1 - Math.exp(-2 * (x + 1))), faint: "M2,3H36" },
  product: { sign: "×" },
  convolve: { line: curve((x) => bell(x - 0.05, 0.2) * 0.95), faint: "M2,12H12M26,12H36M32,8L36,12L32,16" },
  integral: { sign: "∫" },
  sum: { sign: "Σ" },
  weights: { line: "M8,4H30V20H8ZM15,4V20M23,4V20M8,9.5H30M8,15H30" },
  hat: { line: curve((x) => 0.35 + bell(x, 0.2) * 0.95 - bell(x, 0.5) * 0.45), faint: MIDDLE },
  clipped: { line: "M2,21H11V14C14,8 16,3 19,3C22,3 24,8 27,14V21H36", faint: GROUND },
  shifted: { line: curve((x) => bell(x - 0.4, 0.22)), faint: curve((x) => bell(x + 0.35, 0.22)) },
  logistic: { line: curve((x) => 1 / (1 + Math.exp(-9 * x))), faint: "M19,2V22" },
  soft: { line: curve((x) => 0.5 + (2.2 * x) / (1 + Math.abs(4 * x))), faint: "M19,2V22" },
  step: { line: "M2,21H19V3H36", faint: "M19,2V22" },
  ramp: { line: "M2,21H17L34,3", faint: GROUND },
  line: { line: "M4,21L34,3", faint: "M2,12H36M19,2V22" },
  pass: { line: "M4,12H33M27,6L33,12L27,18" },
} satisfies Record<string, SketchDrawing>;

export type Shape = keyof typeof DRAWN;
