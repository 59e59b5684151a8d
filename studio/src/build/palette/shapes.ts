// The small picture of a kind, chosen from its description: its equation, ports and parameters.

import type { Kinds } from "../../inspector/parameters/leaf";
import type { Kind } from "../../protocol";
import { isPart, isSource } from "./families";

// In this order they are listed.
export const SHAPES = [
  "peak",
  "trace",
  "winner",
  "node",
  "bell",
  "box",
  "moving",
  "flat",
  "noise",
  "samples",
  "series",
  "decay",
  "product",
  "convolve",
  "integral",
  "sum",
  "weights",
  "hat",
  "clipped",
  "shifted",
  "logistic",
  "soft",
  "step",
  "ramp",
  "line",
  "pass",
] as const;

export type Shape = (typeof SHAPES)[number];

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

const EXPONENTIAL = /\\exp|e\^\{/g;
const has = (kind: Kind, form: string) => kind.parameters.some((p) => p.form === form);

function curve(kind: Kind, equation: string): Shape {
  const exponentials = equation.match(EXPONENTIAL)?.length ?? 0;
  const cases = equation.includes("cases");
  if (has(kind, "part")) {
    return "shifted";
  }
  if (exponentials > 1) {
    return "hat";
  }
  if (exponentials === 1) {
    return cases ? "clipped" : "bell";
  }
  return cases ? "box" : "samples";
}

function sigmoid(equation: string): Shape {
  if (equation.includes("|u")) {
    return "soft";
  }
  if (/\\exp|e\^/.test(equation)) {
    return "logistic";
  }
  return equation.includes("cases") ? "step" : equation.includes("max") ? "ramp" : "line";
}

function source(kind: Kind, equation: string): Shape {
  if (equation.includes("\\xi")) {
    return "noise";
  }
  if (/\\exp|e\^/.test(equation)) {
    return /_i\(t\)/.test(equation) ? "moving" : "bell";
  }
  if (equation.includes("cases")) {
    return "box";
  }
  return has(kind, "array") ? (/\(x, t\)/.test(equation) ? "series" : "samples") : "flat";
}

// What interacts without a threshold of activation has one winner.
const hasLevels = (kind: Kind) => Object.keys(kind.levels).length > 0;

// What builds up and decays at different rates is a trace.
function dynamics(kind: Kind, equation: string): Shape {
  if (!has(kind, "axes")) {
    return "node";
  }
  return equation.includes("cases") ? "trace" : "peak";
}

function between(kind: Kind, equation: string, kinds: Kinds): Shape {
  const parts = kind.parameters.flatMap((p) => p.of.map((name) => kinds.get(name)?.room));
  const changes = /\\frac\{d\w/.test(equation) || /\\tau/.test(equation);
  if (changes && parts.includes("kernels")) {
    return hasLevels(kind) ? "peak" : "winner";
  }
  if (changes && parts.includes("sigmoids")) {
    return dynamics(kind, equation);
  }
  if (changes) {
    return "decay";
  }
  if (parts.includes("kernels")) {
    return "convolve";
  }
  if (parts.includes("sigmoids")) {
    return "logistic";
  }
  if (/W\(|T_i/.test(equation)) {
    return "weights";
  }
  if (/\\exp/.test(equation)) {
    return "bell";
  }
  if (equation.includes("\\int")) {
    return "integral";
  }
  if (equation.includes("\\sum")) {
    return "sum";
  }
  return equation.includes("\\cdot") ? "product" : /cases|max|min/.test(equation) ? "ramp" : "pass";
}
