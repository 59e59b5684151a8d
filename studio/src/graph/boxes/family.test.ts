import { expect, test } from "vitest";
import { fakeElement, fakeKind } from "../fakes";
import { elementFamily } from "./family";

const levels = { activation: { threshold: "sigmoid.threshold" } };

test("the family follows from room, ports and levels", () => {
  const plain = fakeElement("a");
  const source = fakeElement("s", "S", { inputs: [] });
  expect(elementFamily(source, fakeKind("S", "elements"))).toBe("source");
  expect(elementFamily(plain, fakeKind("F", "elements", { levels }))).toBe("activation");
  expect(elementFamily(plain, fakeKind("M", "elements"))).toBe("other");
  expect(elementFamily(plain, fakeKind("G", "couplings"))).toBe("coupling");
});

test("a kind of a package without declarations has a family", () => {
  expect(elementFamily(fakeElement("a"), undefined)).toBe("other");
  expect(elementFamily(fakeElement("a", "K", { inputs: [] }), undefined)).toBe("source");
});
