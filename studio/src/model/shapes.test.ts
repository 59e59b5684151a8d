import { expect, test } from "vitest";

import { fakeForm, fakeKind, kindsOf } from "../architecture/fakes";
import { type Shape, shapeOf } from "./shapes";

const GAUSS = "\\exp\\!\\left( -\\frac{d^2}{2 \\sigma^2} \\right)";
const CASES = "\\begin{cases} 1 & u > 0 \\\\ 0 & \\text{else} \\end{cases}";
const LOGISTIC = "\\frac{1}{1 + e^{-\\beta u}}";
const sigmoid = fakeKind("S", "sigmoids", { equation: [LOGISTIC] });
const kernel = fakeKind("K", "kernels", { equation: [GAUSS] });
const output = { ports: { output: "over `axes`" } };
const through = { ports: { input: "any axes", output: "the same" } };
const axes = fakeForm("axes", "axes");

const WANTED: [string, string, Parameters<typeof fakeKind>[2], Shape][] = [
  ["a kernel with one exponential", "kernels", { equation: [GAUSS] }, "bell"],
  ["a kernel with two", "kernels", { equation: [`${GAUSS} - ${GAUSS}`] }, "hat"],
  ["a kernel by cases", "kernels", { equation: [CASES] }, "box"],
  ["a kernel from an array", "kernels", { equation: ["w[d]"] }, "samples"],
  ["a logistic sigmoid", "sigmoids", { equation: [LOGISTIC] }, "logistic"],
  ["a sigmoid by cases", "sigmoids", { equation: [CASES] }, "step"],
  ["a Gaussian source", "elements", { equation: [GAUSS], ...output }, "bell"],
  ["a source of noise", "elements", { equation: ["\\xi_n(x)"], ...output }, "noise"],
  ["a constant source", "elements", { equation: ["s(x) = a"], ...output }, "flat"],
  [
    "dynamics with a sigmoid over axes",
    "elements",
    {
      equation: ["\\tau \\frac{du}{dt}"],
      parameters: [axes, fakeForm("g", "part", { of: ["S"] })],
      ...through,
    },
    "peak",
  ],
  [
    "dynamics that build up and decay at different rates",
    "elements",
    {
      equation: [`\\frac{dp}{dt} = ${CASES}`],
      parameters: [axes, fakeForm("activity", "part", { of: ["S"] })],
      ...through,
    },
    "trace",
  ],
  [
    "dynamics with a kernel, without a threshold of activation",
    "elements",
    {
      equation: ["\\tau \\frac{dr}{dt}"],
      parameters: [axes, fakeForm("kernel", "parts", { of: ["K"] })],
      ...through,
    },
    "winner",
  ],
  [
    "dynamics with a kernel and a threshold",
    "elements",
    {
      equation: ["\\tau \\frac{du}{dt}"],
      parameters: [axes, fakeForm("kernel", "parts", { of: ["K"] })],
      levels: { activation: { threshold: "threshold" } },
      ...through,
    },
    "peak",
  ],
  ["dynamics without one", "elements", { equation: ["\\frac{dx}{dt}"], ...through }, "decay"],
  ["a sum", "couplings", { equation: ["\\sum \\mathrm{inputs}"], ...through }, "sum"],
];

test.each(WANTED)("the sketch of %s follows from its description", (_, room, more, shape) => {
  const kind = fakeKind("Any", room, more);
  expect(shapeOf(kind, kindsOf(kind, sigmoid, kernel))).toBe(shape);
  expect(shapeOf({ ...kind, name: "Other", title: "Other" }, kindsOf(sigmoid, kernel))).toBe(shape);
});
