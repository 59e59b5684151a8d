import { expect, test } from "vitest";
import { fakeDocument, fakeElement } from "../architecture/fakes";
import { dragged, pressed, stepped, strengthOf, widthOf } from "./strength";

const NONE = { shiftKey: false, ctrlKey: false, metaKey: false };

test("a pixel is 0.05, with Shift 0.005, and with Ctrl the number is a multiple of 0.5", () => {
  expect(stepped(dragged(1, 40, NONE), NONE)).toBe(3);
  expect(stepped(dragged(1, -3, NONE), NONE)).toBe(0.85);
  expect(stepped(dragged(1, 3, { ...NONE, shiftKey: true }), NONE)).toBe(1.015);
  expect(stepped(dragged(1, 17, NONE), { ...NONE, ctrlKey: true })).toBe(2);
  expect(stepped(dragged(1, 17, NONE), { ...NONE, metaKey: true })).toBe(2);
});

test("arrow keys are 0.1, and - is the other sign", () => {
  expect(
    ["ArrowUp", "ArrowRight", "ArrowDown", "ArrowLeft", "-", "a"].map((key) => pressed(0.3, key)),
  ).toEqual([0.4, 0.4, 0.2, 0.2, -0.3, null]);
});

test("a wire is 1.4 to 2.6 px wide, with the logarithm of its strength", () => {
  expect([0, 0.01, 0.1, 1, -1, 10, -100].map(widthOf)).toEqual([1.4, 1.4, 1.4, 2, 2, 2.6, 2.6]);
  expect(widthOf(3)).toBeCloseTo(2.286, 3);
});

test("the strength is that of the Gain, of the one coupling with a single number, or 1", () => {
  const convolution = { strength: "kernel.0.amplitude", values: { kernel: [{ amplitude: -12 }] } };
  const document = fakeDocument([
    fakeElement("g", "Gain", { strength: "factor", values: { factor: 3 } }),
    fakeElement("k", "Convolve", convolution),
    fakeElement("w", "Weights"),
  ]);
  const elements = new Map(document.elements.map((element) => [element.id, element]));
  const of = (...couplings: string[]) => strengthOf({ couplings, gain: null }, { elements, document });
  expect([of(), of("g"), of("k"), of("w"), of("w", "k"), of("g", "k")]).toEqual([1, 3, -12, 1, -12, 1]);
  const driven = { name: "drive", value: 5, links: [{ element: "g", parameter: "factor" }] };
  const shared = { ...document, parameters: [driven] };
  expect(strengthOf({ couplings: ["g"], gain: "g" }, { elements, document: shared })).toBe(5);
});
