import { expect, it } from "vitest";
import type { DocumentView, ElementView, Kind } from "../protocol";
import { levelsOf, pushAmplitude, thresholdOf } from "./levels";

const kind = { levels: { charge: { threshold: "gate.theta", rest: "rest" } } } as unknown as Kind;
const element = { id: "a", values: { gate: { theta: 0.5 }, rest: -4 } } as unknown as ElementView;
const documentOf = (parameters: DocumentView["parameters"]) => ({ parameters }) as unknown as DocumentView;

it("levels have the values of their parameters", () => {
  expect(levelsOf(documentOf([]), element, kind, "charge")).toEqual([
    { label: "threshold", value: 0.5 },
    { label: "rest", value: -4 },
  ]);
  expect(levelsOf(documentOf([]), element, kind, "output")).toEqual([]);
  expect(levelsOf(documentOf([]), element, undefined, "charge")).toEqual([]);
});

it("a document parameter that drives a level gives its value", () => {
  const all = { name: "all", value: -7, links: [{ element: "a", parameter: "rest" }] };
  expect(levelsOf(documentOf([all]), element, kind, "charge")[1]).toEqual({ label: "rest", value: -7 });
});

it("the amplitude of an injection is twice the distance of the levels", () => {
  expect(pushAmplitude(levelsOf(documentOf([]), element, kind, "charge"))).toBe(9);
  expect(pushAmplitude([])).toBe(5);
  expect(thresholdOf([{ label: "rest", value: 1 }])).toBeNull();
});
