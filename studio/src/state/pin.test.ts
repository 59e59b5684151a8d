import { expect, test } from "vitest";

import { fakeLayout } from "../architecture/fakes";
import type { PinView } from "../protocol";
import { boxPins, changedPin, endsOf, withoutPin, withPin } from "./pin";

const tau: PinView = { element: "1", parameter: "tau" };
const tempo: PinView = { element: "", parameter: "tempo", lower: 0, upper: 5, label: "pace" };

test("a parameter is pinned once", () => {
  const pins = withPin([], "1", "tau");
  expect(pins).toEqual([tau]);
  expect(withPin(pins, "1", "tau")).toBe(pins);
  expect(withoutPin([tau, tempo], "1", "tau")).toEqual([tempo]);
});

test("range and label of one pin are changed", () => {
  expect(changedPin([tau, tempo], tau, { lower: 1, upper: 9 })).toEqual([
    { ...tau, lower: 1, upper: 9 },
    tempo,
  ]);
  expect(changedPin([tempo], tempo, { lower: undefined, upper: undefined })).toEqual([
    { element: "", parameter: "tempo", label: "pace" },
  ]);
  expect(changedPin([tempo], tempo, { label: undefined })).toEqual([
    { element: "", parameter: "tempo", lower: 0, upper: 5 },
  ]);
});

test("a switch goes between the ends of the chosen range, or between 0 and 1", () => {
  expect(endsOf(tau)).toEqual([0, 1]);
  expect(endsOf({ ...tempo, upper: -1, lower: -2 })).toEqual([-2, -1]);
  expect(changedPin([tau, tempo], tempo, { switch: true })).toEqual([tau, { ...tempo, switch: true }]);
  const switched = { ...tau, switch: true };
  expect(changedPin([switched], switched, { switch: undefined })).toEqual([tau]);
});

test("a box has the first two sliders of its element, without switches", () => {
  const of = (element: string, parameter: string, more: Partial<PinView> = {}) => ({
    element,
    parameter,
    ...more,
  });
  const pins = [
    of("1", "a", { switch: true }),
    of("2", "a"),
    of("1", "b"),
    of("1", "c"),
    of("1", "d"),
    tempo,
  ];
  expect(
    ["1", "2", "3"].map((id) => boxPins(fakeLayout({ pins }), id).map(({ parameter }) => parameter)),
  ).toEqual([["b", "c"], ["a"], []]);
});
