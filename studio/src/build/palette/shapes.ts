// The small picture of a kind, chosen from its description: its equation, ports and parameters.

import type { Kinds } from "../../inspector/parameters/leaf";
import type { Kind } from "../../protocol";
import { isPart, isSource } from "./families";
import type { Shape } from "./sketches";

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
