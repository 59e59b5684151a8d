import { expect, test } from "vitest";
import { fakeElement, fakeKind, kindsOf } from "./fakes";
import { find } from "./find";

const KINDS = kindsOf(
  fakeKind("Field", "elements", { title: "Neural field" }),
  fakeKind("Gain", "couplings", { title: "Gain" }),
);
const ELEMENTS = [
  fakeElement("arm.field"),
  fakeElement("field"),
  fakeElement("arm.hand.grip"),
  fakeElement("k", "Gain"),
];

const paths = (text: string) => find(text, ELEMENTS, KINDS).map((found) => found.path);

test("the search finds elements by name, path and kind", () => {
  expect(paths("grip")).toEqual(["arm.hand.grip"]);
  expect(paths("arm")).toEqual(["arm.field", "arm.hand.grip"]);
  expect(paths("gain")).toEqual(["k"]);
});

test("every word must match, and matches of the name come first", () => {
  expect(paths("neural ARM")).toEqual(["arm.field", "arm.hand.grip"]);
  expect(paths("field")).toEqual(["arm.field", "field", "arm.hand.grip"]);
  expect(paths("nothing")).toEqual([]);
});

test("an empty search shows all elements", () => {
  expect(paths(" ")).toHaveLength(4);
});
