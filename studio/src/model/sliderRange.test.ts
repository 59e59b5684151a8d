import { describe, expect, test } from "vitest";

import type { AxisView, ParameterForm } from "../protocol";
import {
  dragged,
  finer,
  chosen,
  defaultAt,
  including,
  nudged,
  sliderRange,
  snapped,
  type Standing,
} from "./sliderRange";

const form = (given: Partial<ParameterForm>): ParameterForm => ({
  name: "p",
  form: "number",
  cost: "live",
  meaning: "",
  description: "",
  symbol: "",
  unit: "",
  lower: null,
  upper: null,
  default: 0,
  optional: false,
  choices: [],
  of: [],
  ...given,
});

const axis = (key: string, lower: number, upper: number): AxisView => ({
  key,
  name: key,
  lower,
  upper,
  samples: 11,
  periodic: false,
  unit: "deg",
});

const standing = (path = "p", axes: AxisView[] = [], own = true): Standing => ({ path, axes, own });

const ends = (given: Partial<ParameterForm>, value: unknown, place = standing()) => {
  const { lower, upper } = sliderRange(form(given), value, place);
  return [lower, upper];
};

describe("a range from declared bounds", () => {
  test("two bounds are the range", () =>
    expect(ends({ lower: 0, upper: 1, default: 0.15 }, 0.15)).toEqual([0, 1]));

  test("bounds that are far apart only limit the range", () => {
    const range = sliderRange(form({ lower: 1e-6, upper: 1e6, default: 4 }), 4, standing());
    expect(range).toMatchObject({ lower: 0.1, upper: 100, logarithmic: true });
  });

  test("one bound ends the range", () => {
    expect(ends({ lower: 0, default: 1 }, 1)).toEqual([0, 2]);
    expect(ends({ lower: -3, default: 5 }, 5)).toEqual([-3, 10]);
    expect(ends({ upper: 0, default: -5 }, -5)).toEqual([-10, 0]);
    expect(ends({ lower: 20, default: 0 }, 30)[0]).toBe(20);
    expect(ends({ lower: 500, default: 0 }, 600)).toEqual([500, 2000]);
    expect(ends({ lower: 500, default: 0 }, null)).toEqual([500, 501]);
  });
});

describe("a range from the size of default and value", () => {
  test.each([
    [-5, -5, [-10, 10]],
    [1, 12, [-30, 30]],
    [0, 0.6, [-2, 2]],
    [1, -6, [-20, 20]],
    [0.5, 0.5, [-1, 1]],
  ])("default %d, value %d", (byDefault, value, range) =>
    expect(ends({ default: byDefault }, value)).toEqual(range),
  );

  test("the range is two to four times the size", () => {
    for (let value = 0.013; value < 1000; value *= 1.37) {
      const [, upper = 0] = ends({ default: 0 }, value);
      expect(upper / value).toBeGreaterThanOrEqual(2 - 1e-9);
      expect(upper / value).toBeLessThanOrEqual(4 + 1e-9);
    }
  });

  test("zeros have the usual range of their unit", () => {
    expect(ends({ unit: "activation" }, 0)).toEqual([-10, 10]);
    expect(ends({ unit: "activation", lower: 0 }, 0)).toEqual([0, 10]);
    expect(ends({ unit: "time" }, 0)).toEqual([0, 1000]);
    expect(ends({}, 0)).toEqual([-1, 1]);
  });

  test("times are positive, unless the value is negative", () => {
    expect(ends({ unit: "time", default: 0 }, 100)).toEqual([0, 200]);
    expect(ends({ unit: "time", default: 0 }, -100)).toEqual([-200, 200]);
  });

  test("infinite durations do not set the range", () => {
    expect(ends({ unit: "time", default: 1e30 }, 600)).toEqual([0, 2000]);
    expect(ends({ unit: "time", default: 1e30 }, 1e30)).toEqual([0, 1000]);
  });

  test("a missing value has the usual range", () => expect(ends({ default: null }, null)).toEqual([-1, 1]));
});

describe("logarithmic ranges", () => {
  test.each([
    [20, [1, 1000]],
    [100, [10, 1000]],
    [0.5, [0.01, 10]],
  ])("a time constant of %d", (value, [lower, upper]) => {
    const range = sliderRange(form({ unit: "time", lower: 1e-6, default: value }), value, standing());
    expect(range.logarithmic).toBe(true);
    expect(range.lower).toBeCloseTo(lower ?? 0, 12);
    expect(range.upper).toBeCloseTo(upper ?? 0, 12);
  });
});

describe("ranges along axes", () => {
  const axes = [axis("x", 0, 100), axis("y", -20, 20)];
  const place = form({ form: "per_axis", unit: "axis" });
  const width = form({ form: "per_axis", unit: "axis", lower: 0, default: 5 });

  test("a position lies on its axis", () => {
    expect(sliderRange(place, 30, standing("p", axes.slice(0, 1)))).toMatchObject({ lower: 0, upper: 100 });
    expect(sliderRange(place, 3, standing("p.1", axes))).toMatchObject({ lower: -20, upper: 20 });
  });

  test("one number for several axes lies on any of them", () =>
    expect(sliderRange(place, 3, standing("p", axes))).toMatchObject({ lower: -20, upper: 100 }));

  test("a width is at most half the axis", () => {
    expect(sliderRange(width, 5, standing("p.0", axes))).toMatchObject({ lower: 0, upper: 50 });
    expect(sliderRange(width, 5, standing("p.1", axes))).toMatchObject({ lower: 0, upper: 20 });
    expect(sliderRange(width, 5, standing("kernel.0.p", axes))).toMatchObject({ lower: 0, upper: 50 });
  });

  test("a distance is positive or negative", () => {
    expect(sliderRange(place, 3, standing("kernel.0.p", axes.slice(0, 1)))).toMatchObject({
      lower: -50,
      upper: 50,
    });
    expect(sliderRange(place, 3, standing("p", axes.slice(0, 1), false))).toMatchObject({
      lower: -50,
      upper: 50,
    });
  });

  test("without axes the size decides", () =>
    expect(sliderRange(width, 5, standing())).toMatchObject({ lower: 0, upper: 10 }));
});

describe("ranges that grow", () => {
  const range = sliderRange(form({ default: 5, lower: 0 }), 5, standing());

  test("a value inside leaves the range unchanged", () => expect(including(range, 7)).toBe(range));

  test("a value outside moves the end that it exceeds", () => {
    expect(including(range, 45)).toMatchObject({ lower: 0, upper: 50 });
    expect(including(range, -3)).toMatchObject({ lower: -3, upper: 10 });
    expect(
      sliderRange(form({ form: "per_axis", unit: "axis" }), 130, standing("p", [axis("x", 0, 100)])),
    ).toMatchObject({ lower: 0, upper: 200 });
  });

  test("a logarithmic range grows by decades", () => {
    const tau = sliderRange(form({ unit: "time", lower: 1e-6, default: 20 }), 20, standing());
    expect(including(tau, 3000)).toMatchObject({ lower: 1, upper: 10000, logarithmic: true });
  });

  test("a user sets an own range", () => {
    expect(chosen(range, 2, 4)).toMatchObject({ lower: 2, upper: 4, step: 0.01 });
    expect(chosen(range, undefined, 4)).toMatchObject({ lower: 0, upper: 4 });
    expect(chosen(range, 4, 2)).toBe(range);
  });
});

describe("steps", () => {
  test("a range has about two hundred round steps", () => {
    expect(sliderRange(form({ default: 5, lower: 0 }), 5, standing()).step).toBe(0.05);
    expect(sliderRange(form({ lower: 0, upper: 100, default: 5 }), 5, standing()).step).toBe(0.5);
  });

  test("whole numbers have whole steps", () => {
    expect(sliderRange(form({ form: "integer", lower: 1, upper: 10, default: 5 }), 5, standing()).step).toBe(
      1,
    );
    expect(sliderRange(form({ form: "integer", default: 500, lower: 0 }), 500, standing()).step).toBe(5);
  });

  test("a slider takes round values inside its range", () => {
    const range = sliderRange(form({ default: 5, lower: 0 }), 5, standing());
    expect(snapped(3.1385, range)).toBe(3.15);
    expect(snapped(99, range)).toBe(10);
    const tau = sliderRange(form({ unit: "time", lower: 1e-6, default: 20 }), 20, standing());
    expect(snapped(31.41592, tau)).toBe(31.4);
  });

  test("a pixel of a drag is a hundredth of the range, with Shift a thousandth", () => {
    const range = sliderRange(form({ default: 5, lower: 0 }), 5, standing());
    expect(dragged(5, 10, false, range)).toBeCloseTo(6);
    expect(dragged(5, -10, true, range)).toBeCloseTo(4.9);
    expect(dragged(5, 80, false, range)).toBe(10);
    expect(snapped(4.9912, finer(range))).toBe(4.99);
    const whole = sliderRange(form({ form: "integer", default: 500, lower: 0 }), 500, standing());
    expect(snapped(501.2, finer(whole))).toBe(501);
    const tau = sliderRange(form({ unit: "time", lower: 1e-6, default: 20 }), 20, standing());
    expect(dragged(20, 50, false, tau)).toBeCloseTo(20 * Math.sqrt(tau.upper / tau.lower));
  });

  test("keys make fine or coarse steps, never beyond the ends", () => {
    const range = sliderRange(form({ default: 5, lower: 0 }), 5, standing());
    expect(nudged(5, 1, false, range)).toBe(5.05);
    expect(nudged(5, -1, true, range)).toBe(4.5);
    expect(nudged(0, -1, false, range)).toBe(0);
    const tau = sliderRange(form({ unit: "time", lower: 1e-6, default: 20 }), 20, standing());
    expect(nudged(20, 1, false, tau)).toBe(20.4);
    expect(nudged(20, -1, true, tau)).toBe(16);
  });
});

test("numbers inside a parameter have defaults", () => {
  expect(defaultAt(form({ default: 5 }), "kernel.0.p")).toBe(5);
  expect(defaultAt(form({ form: "per_axis", default: 5 }), "p.1")).toBe(5);
  expect(defaultAt(form({ form: "per_axis", default: [1, 2] }), "p.1")).toBe(2);
  expect(defaultAt(form({ form: "numbers", default: { rate: 3 } }), "p.rate")).toBe(3);
  expect(defaultAt(form({ form: "numbers", default: {} }), "p.rate")).toBe(undefined);
});
