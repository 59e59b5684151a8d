// The range of a slider, from the declaration, the default and the value of a parameter.

import type { AxisView, ParameterForm } from "../protocol";
import { valueAt } from "./values";

export type SliderRange = {
  lower: number;
  upper: number;
  logarithmic: boolean;
  step: number;
};

// The context of a parameter: its path below the element, the axes of the element, and whether they are the
// element's own parameter.
export type Standing = {
  path: string;
  axes: AxisView[];
  own: boolean;
};

// Beyond this a number means infinity and does not set a range.
const ENDLESS = 1e12;
// Declared bounds whose distance exceeds this multiple of the value are limits, not a range.
const WIDE = 1e3;
const STEPS = 200;

export function sliderRange(form: ParameterForm, value: unknown, standing: Standing): SliderRange {
  const sizes = [...numbersOf(value), ...numbersOf(defaultAt(form, standing.path))].filter(
    (v) => Math.abs(v) < ENDLESS,
  );
  const whole = form.form === "integer";
  const range = sensible(form, sizes, standing);
  return numbersOf(value).reduce(including, stepped(range.lower, range.upper, range.logarithmic, whole));
}

// The same range where it holds the value, else a wider one; the end that is beaten moves so far that it is
// not beaten again at once.
export function including(range: SliderRange, value: number): SliderRange {
  if ((value >= range.lower && value <= range.upper) || Math.abs(value) >= ENDLESS) {
    return range;
  }
  if (range.logarithmic && value > 0) {
    const lower = value < range.lower ? 10 ** Math.floor(Math.log10(value)) : range.lower;
    const upper = value > range.upper ? 10 ** Math.ceil(Math.log10(value)) : range.upper;
    return stepped(lower, upper, true, false);
  }
  const whole = Number.isInteger(range.step) && Number.isInteger(value);
  const lower = value < range.lower ? Math.min(range.lower, value < 0 ? -nice(-value) : value) : range.lower;
  const upper = value > range.upper ? Math.max(range.upper, value > 0 ? nice(value) : value) : range.upper;
  return stepped(lower, upper, false, whole);
}

// A range that a person chose.
export function chosen(
  range: SliderRange,
  lower: number | undefined,
  upper: number | undefined,
): SliderRange {
  const low = lower ?? range.lower;
  const high = upper ?? range.upper;
  if (!(low < high)) {
    return range;
  }
  const whole =
    Number.isInteger(range.step) &&
    range.step > 0 &&
    Number.isInteger(low) &&
    Number.isInteger(high) &&
    high - low >= STEPS;
  return stepped(low, high, range.logarithmic && low > 0, whole);
}

function sensible(
  form: ParameterForm,
  sizes: number[],
  { path, axes, own }: Standing,
): Omit<SliderRange, "step"> {
  const { lower, upper, unit } = form;
  const size = Math.max(0, ...sizes.map(Math.abs));
  if (
    lower !== null &&
    upper !== null &&
    upper - lower <= WIDE * Math.max(size, Number(form.form === "integer"), Math.abs(lower))
  ) {
    return { lower, upper, logarithmic: false };
  }
  if (unit === "axis" && axes.length > 0) {
    return along(axesAt(axes, form, path), lower, own && path.split(".")[0] === form.name);
  }
  const low = lower ?? -Infinity;
  const high = upper ?? Infinity;
  if (low > 0 && size / low >= WIDE && form.form !== "integer") {
    const decade = Math.log10(size);
    return {
      lower: Math.max(low, 10 ** Math.floor(decade - 1)),
      upper: Math.min(high, 10 ** Math.ceil(decade + 1)),
      logarithmic: true,
    };
  }
  const far = size > 0 ? nice(2 * size) : ifZero(unit);
  const negative = low < 0 && !(unit === "time" && sizes.every((v) => v >= 0));
  return within(negative ? -far : 0, far, low, high);
}

// Places lie on the axis, distances (of parts inside, of elements without axes of their own) go both ways,
// widths up to half the axis.
function along(axes: AxisView[], bound: number | null, place: boolean): Omit<SliderRange, "step"> {
  const half = Math.max(...axes.map((axis) => (axis.upper - axis.lower) / 2));
  if (bound !== null) {
    return { lower: bound, upper: Math.max(half, bound + half), logarithmic: false };
  }
  if (!place) {
    return { lower: -half, upper: half, logarithmic: false };
  }
  return {
    lower: Math.min(...axes.map((axis) => axis.lower)),
    upper: Math.max(...axes.map((axis) => axis.upper)),
    logarithmic: false,
  };
}

// One axis where the path ends in its number, else all.
export function axesAt(axes: AxisView[], form: ParameterForm, path: string): AxisView[] {
  const last = path.split(".").at(-1) ?? "";
  const one = form.form === "per_axis" && /^\d+$/.test(last) ? axes[Number(last)] : undefined;
  return one === undefined ? axes : [one];
}

function within(lower: number, upper: number, low: number, high: number): Omit<SliderRange, "step"> {
  const least = Math.max(lower, low);
  const most = Math.min(upper, high);
  if (least < most) {
    return { lower: least, upper: most, logarithmic: false };
  }
  return low > lower
    ? { lower: low, upper: low + upper, logarithmic: false }
    : { lower: high - upper, upper: high, logarithmic: false };
}

// For a value of 0 with a default of 0: the usual size in this unit.
function ifZero(unit: string): number {
  return unit === "activation" ? 10 : unit === "time" ? 1000 : 1;
}

function stepped(lower: number, upper: number, logarithmic: boolean, whole: boolean): SliderRange {
  const step = fine((upper - lower) / STEPS);
  return { lower, upper, logarithmic, step: whole ? Math.max(1, Math.round(step)) : step };
}

// The smallest of 1, 2, 3, 4, 5, 6, 8, 10 times a power of ten that is not below the value.
function nice(value: number): number {
  const decade = 10 ** Math.floor(Math.log10(value));
  const factor = [1, 2, 3, 4, 5, 6, 8, 10].find((f) => f * decade >= value * (1 - 1e-9)) ?? 10;
  return Number((factor * decade).toPrecision(3));
}

// The largest of 1, 2, 5 times a power of ten that is not above the value.
function fine(value: number): number {
  const decade = 10 ** Math.floor(Math.log10(value));
  const factor = [5, 2, 1].find((f) => f * decade <= value * (1 + 1e-9)) ?? 1;
  return Number((factor * decade).toPrecision(3));
}

function numbersOf(value: unknown): number[] {
  return [value].flat().filter((v): v is number => typeof v === "number");
}

// The default of a parameter, or of the number inside it that the path ends in.
export function defaultAt(form: ParameterForm, path: string): unknown {
  const steps = path.split(".");
  const inside = steps.slice(steps.lastIndexOf(form.name) + 1).join(".");
  if (inside === "") {
    return form.default;
  }
  return form.form === "per_axis" && typeof form.default === "number"
    ? form.default
    : valueAt(form.default, inside);
}

// ---------------------------------------------------------------------------------------------- values on a
// slider

// The round value nearest to the position of the slider.
export function snapped(value: number, range: SliderRange): number {
  const round = range.logarithmic
    ? Number(value.toPrecision(3))
    : Number((Math.round(value / range.step) * range.step).toPrecision(12));
  return Math.min(range.upper, Math.max(range.lower, round));
}

// Pixels of a drag further: a hundredth of the range each, with Shift a tenth of that.
export function dragged(value: number, pixels: number, fine: boolean, range: SliderRange): number {
  const { lower, upper, logarithmic } = range;
  const share = pixels * (fine ? 0.001 : 0.01);
  const next = logarithmic && value > 0 ? value * (upper / lower) ** share : value + share * (upper - lower);
  return Math.min(upper, Math.max(lower, next));
}

// The same range with steps ten times as fine; whole ones stay whole.
export function finer(range: SliderRange): SliderRange {
  const step = range.step / 10;
  return { ...range, step: Number.isInteger(range.step) ? Math.max(1, Math.round(step)) : step };
}

// One key press further. Coarse is ten steps; on a logarithmic range a step is a share of the value.
export function nudged(value: number, direction: 1 | -1, coarse: boolean, range: SliderRange): number {
  if (range.logarithmic && value > 0) {
    const factor = coarse ? 1.25 : 1.02;
    return snapped(direction > 0 ? value * factor : value / factor, range);
  }
  const step = coarse ? 10 * range.step : range.step;
  const next = value + direction * step;
  return Number(Math.min(range.upper, Math.max(range.lower, next)).toPrecision(12));
}
