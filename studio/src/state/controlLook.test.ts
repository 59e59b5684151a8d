import { expect, test } from "vitest";

import type { AxisView, ElementView, Kind, ParameterForm } from "../protocol";
import { lookOf } from "./controlLook";

const form = (given: Partial<ParameterForm>): ParameterForm => ({
  name: "place",
  form: "per_axis",
  cost: "rebuild",
  meaning: "where",
  description: "where it lies.",
  symbol: "\\mu",
  unit: "axis",
  lower: null,
  upper: null,
  default: 0,
  optional: false,
  choices: [],
  of: [],
  ...given,
});
const kind = {
  name: "Spot",
  parameters: [form({ name: "axes", form: "axes", unit: "" }), form({})],
} as unknown as Kind;
const axes = [
  { key: "x", name: "x", lower: 0, upper: 100, unit: "deg" },
  { key: "y", name: "y", lower: -20, upper: 20, unit: "cm" },
] as AxisView[];
const element = {
  id: "1",
  kind: "Spot",
  values: { axes: ["x", "y"], place: [30, 5] },
  axes: {},
} as unknown as ElementView;
const around = { kinds: new Map([["Spot", kind]]), axes, timeUnit: "ms" };

test("a number outside the inspector has the range, unit, symbol and cost of its form", () => {
  const look = lookOf(around, element, "place.1", 5);
  expect(look).toMatchObject({
    unit: "cm",
    symbol: "\\mu",
    cost: "rebuild",
    meaning: "where it lies.",
    optional: false,
  });
  expect(look?.range).toMatchObject({ lower: -20, upper: 20 });
});

test("a path without a number has no look", () => {
  expect(lookOf(around, element, "place.2", 5)).toBe(undefined);
  expect(lookOf(around, undefined, "place", 5)).toBe(undefined);
});
