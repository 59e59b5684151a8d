// The small picture of a kind, chosen from its description: its equation, ports and parameters.

import type { Kinds } from "./leaf";
import type { Kind } from "../protocol";
import { isPart, isSource } from "./families";

export type SketchDrawing = { line?: string; faint?: string; sign?: string };

// A curve over -1 to 1; the values 0 to 1 fill the height.
function graph(value: (x: number) => number): string {
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
  peak: { line: graph((x) => 0.08 + 0.92 * bell(x, 0.24)), faint: "M2,12H36" },
  trace: {
    line: graph((x) => 0.42 * bell(x + 0.3, 0.24) + 0.3 * bell(x - 0.4, 0.2)),
    faint: graph((x) => bell(x + 0.3, 0.16)),
  },
  winner: {
    line: graph((x) => bell(x, 0.15)),
    faint: graph((x) => 0.4 * bell(x + 0.62, 0.13) + 0.4 * bell(x - 0.62, 0.13)),
  },
  node: { line: "M10,12A9,9 0 1 1 28,12A9,9 0 1 1 10,12", faint: "M2,12H10M28,12H36" },
  bell: { line: graph((x) => bell(x)), faint: GROUND },
  box: { line: "M2,21H12V4H26V21H36", faint: GROUND },
  moving: { line: graph((x) => bell(x + 0.35, 0.25)), faint: "M22,8H34M30,4L34,8L30,12" },
  flat: { line: "M2,9H36", faint: GROUND },
  noise: { line: `M${zigzag}` },
  samples: { line: "M5,21V13M12,21V8M19,21V3M26,21V10M33,21V15", faint: GROUND },
  series: { line: "M2,18L8,15L14,6L20,9L26,4L32,14L36,12", faint: GROUND },
  decay: { line: graph((x) => 1 - Math.exp(-2 * (x + 1))), faint: "M2,3H36" },
  product: { sign: "×" },
  convolve: { line: graph((x) => bell(x - 0.05, 0.2) * 0.95), faint: "M2,12H12M26,12H36M32,8L36,12L32,16" },
  integral: { sign: "∫" },
  sum: { sign: "Σ" },
  weights: { line: "M8,4H30V20H8ZM15,4V20M23,4V20M8,9.5H30M8,15H30" },
  hat: { line: graph((x) => 0.35 + bell(x, 0.2) * 0.95 - bell(x, 0.5) * 0.45), faint: MIDDLE },
  clipped: { line: "M2,21H11V14C14,8 16,3 19,3C22,3 24,8 27,14V21H36", faint: GROUND },
  shifted: { line: graph((x) => bell(x - 0.4, 0.22)), faint: graph((x) => bell(x + 0.35, 0.22)) },
  logistic: { line: graph((x) => 1 / (1 + Math.exp(-9 * x))), faint: "M19,2V22" },
  soft: { line: graph((x) => 0.5 + (2.2 * x) / (1 + Math.abs(4 * x))), faint: "M19,2V22" },
  step: { line: "M2,21H19V3H36", faint: "M19,2V22" },
  ramp: { line: "M2,21H17L34,3", faint: GROUND },
  line: { line: "M4,21L34,3", faint: "M2,12H36M19,2V22" },
  pass: { line: "M4,12H33M27,6L33,12L27,18" },
} satisfies Record<string, SketchDrawing>;

export type Shape = keyof typeof DRAWN;

export function shapeOf(kind: Kind, kinds: Kinds): Shape {
  const equation = kind.equation.join(" ");
  if (kind.room === "sigmoids") {
    return sigmoid(equation);
  }
  if (isPart(kind)) {
    return curve(kind, equation);
  }
  return isSource(kind) ? source(kind, equation) : between(kind, equation, kinds);
}

type Rule = [holds: boolean, shape: Shape];

// The shape of the first rule that holds.
function first(otherwise: Shape, ...rules: Rule[]): Shape {
  return rules.find(([holds]) => holds)?.[1] ?? otherwise;
}

const EXPONENTIAL = /\\exp|e\^\{/g;
const has = (kind: Kind, form: string) => kind.parameters.some((p) => p.form === form);

function curve(kind: Kind, equation: string): Shape {
  const exponentials = equation.match(EXPONENTIAL)?.length ?? 0;
  const cases = equation.includes("cases");
  return first(
    cases ? "box" : "samples",
    [has(kind, "part"), "shifted"],
    [exponentials > 1, "hat"],
    [exponentials === 1, cases ? "clipped" : "bell"],
  );
}

function sigmoid(equation: string): Shape {
  return first(
    "line",
    [equation.includes("|u"), "soft"],
    [/\\exp|e\^/.test(equation), "logistic"],
    [equation.includes("cases"), "step"],
    [equation.includes("max"), "ramp"],
  );
}

function source(kind: Kind, equation: string): Shape {
  return first(
    "flat",
    [equation.includes("\\xi"), "noise"],
    [/\\exp|e\^/.test(equation), /_i\(t\)/.test(equation) ? "moving" : "bell"],
    [equation.includes("cases"), "box"],
    [has(kind, "array"), /\(x, t\)/.test(equation) ? "series" : "samples"],
  );
}

// What interacts without a threshold of activation has one winner.
const hasLevels = (kind: Kind) => Object.keys(kind.levels).length > 0;

// What builds up and decays at different rates is a trace.
function dynamics(kind: Kind, equation: string): Shape {
  return first("peak", [!has(kind, "axes"), "node"], [equation.includes("cases"), "trace"]);
}

function between(kind: Kind, equation: string, kinds: Kinds): Shape {
  const parts = kind.parameters.flatMap((p) => p.of.map((name) => kinds.get(name)?.room));
  const changes = /\\frac\{d\w/.test(equation) || /\\tau/.test(equation);
  const [kernels, sigmoids] = [parts.includes("kernels"), parts.includes("sigmoids")];
  return first(
    "pass",
    [changes && kernels, hasLevels(kind) ? "peak" : "winner"],
    [changes && sigmoids, dynamics(kind, equation)],
    [changes, "decay"],
    [kernels, "convolve"],
    [sigmoids, "logistic"],
    [/W\(|T_i/.test(equation), "weights"],
    [/\\exp/.test(equation), "bell"],
    [equation.includes("\\int"), "integral"],
    [equation.includes("\\sum"), "sum"],
    [equation.includes("\\cdot"), "product"],
    [/cases|max|min/.test(equation), "ramp"],
  );
}
