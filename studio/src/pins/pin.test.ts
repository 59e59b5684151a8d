import { describe, expect, test } from "vitest";

import { boxPins, changedPin, endsOf, pinsOf, withoutPin, withPin, type Pin } from "./pin";

const tau: Pin = { element: "1", parameter: "tau" };
const tempo: Pin = { element: "", parameter: "tempo", lower: 0, upper: 5, label: "pace" };

describe("pins in a document", () => {
  test("are none without a valid list", () => {
    expect(pinsOf(undefined)).toEqual([]);
    expect(pinsOf({})).toEqual([]);
    expect(pinsOf({ pins: "nonsense" })).toEqual([]);
  });

  test("invalid entries are skipped", () => {
    expect(
      pinsOf({ pins: [tau, null, 3, { element: 1, parameter: "tau" }, { element: "1" }, tempo] }),
    ).toEqual([tau, tempo]);
    expect(pinsOf({ pins: [{ ...tau, lower: "low", upper: null, label: "", color: "red" }] })).toEqual([tau]);
  });

  test("the first of two equal pins is used", () =>
    expect(pinsOf({ pins: [tempo, { ...tempo, label: "other" }] })).toEqual([tempo]));

  test("the same layout gives the same list, so that nothing is drawn again", () => {
    const layout = { pins: [tau] };
    expect(pinsOf(layout)).toBe(pinsOf({ ...layout }));
  });
});

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
  expect(changedPin([tempo], tempo, { label: "" })).toEqual([
    { element: "", parameter: "tempo", lower: 0, upper: 5 },
  ]);
});

test("a switch goes between the ends of the chosen range, or between 0 and 1", () => {
  expect(
    pinsOf({
      pins: [
        { ...tau, switch: true },
        { ...tempo, switch: 1 },
      ],
    }),
  ).toEqual([{ ...tau, switch: true }, tempo]);
  expect(endsOf(tau)).toEqual([0, 1]);
  expect(endsOf({ ...tempo, upper: -1, lower: -2 })).toEqual([-2, -1]);
  expect(changedPin([tau, tempo], tempo, { switch: true })).toEqual([tau, { ...tempo, switch: true }]);
  const switched = { ...tau, switch: true };
  expect(changedPin([switched], switched, { switch: undefined })).toEqual([tau]);
});

test("a box has the first two sliders of its element, without switches", () => {
  const of = (element: string, parameter: string, more: Partial<Pin> = {}) => ({
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
  expect(["1", "2", "3"].map((id) => boxPins({ pins }, id).map(({ parameter }) => parameter))).toEqual([
    ["b", "c"],
    ["a"],
    [],
  ]);
});
