import { expect, test } from "vitest";

import { FIRST_GOALS, requirements, tunable } from "./goals";

test("goals that are on are requirements", () => {
  expect(requirements(FIRST_GOALS)).toEqual([{ detects: { at: 3, within: 0.2 } }]);
  expect(requirements({ ...FIRST_GOALS, detection: { on: false, at: 3, within: 0.2 } })).toEqual([]);
  expect(
    requirements({
      detection: { on: true, at: 3, within: 0.2 },
      width: { on: true, at: 8, within: 0.5 },
      after: "remembers",
      two: "selects",
    }),
  ).toEqual([
    { detects: { at: 3, within: 0.2 } },
    { peak_width: { width: 8, within: 0.5 } },
    "remembers",
    "selects",
  ]);
});

test("numbers of the field and its kernels are tuned, its time constant is not", () => {
  const values = {
    tau: 20,
    resting_level: -5,
    global_inhibition: 0,
    kernel: [
      { kind: "Gaussian", amplitude: 12, sigma: 5 },
      { kind: "Tabulated" },
      { kind: "Pair", sigma: [3, 4] },
    ],
    sigmoid: { kind: "Logistic", beta: 4 },
  };
  expect(tunable(values)).toEqual([
    { name: "resting_level", usual: true },
    { name: "global_inhibition", usual: false },
    { name: "kernel.0.amplitude", usual: true },
    { name: "kernel.0.sigma", usual: true },
    { name: "sigmoid.beta", usual: false },
  ]);
  expect(tunable({ resting_level: -5 })).toEqual([{ name: "resting_level", usual: true }]);
});
