import { expect, test } from "vitest";
import { fakeElement } from "./fakes";
import { around, below, hiddenBy, outside, tree } from "./tree";

const elements = [
  fakeElement("top"),
  fakeElement("arm.hand.u"),
  fakeElement("arm.v"),
  fakeElement("arm.gain"),
];

test("groups nest, also those that only elements name", () => {
  const found = tree(elements, [["empty"]], [], new Set());
  expect(found.root.groups.map((g) => g.key)).toEqual(["empty", "arm"]);
  expect(found.groups.get("arm/hand")).toMatchObject({ name: "hand", elements: ["arm.hand.u"], count: 1 });
  expect(found.groups.get("arm")?.count).toBe(3);
  expect(around(found, "arm.hand.u").map((g) => g.key)).toEqual(["arm", "arm/hand"]);
  expect(outside(found, "arm/hand").map((g) => g.key)).toEqual(["arm"]);
  expect([outside(found, "arm"), outside(found, "gone")]).toEqual([[], []]);
});

test("couplings on edges are counted but have no box of their own", () => {
  const found = tree(elements, [], [], new Set(["arm.gain"]));
  const arm = found.groups.get("arm");
  expect(arm?.count).toBe(3);
  expect(arm === undefined ? [] : below(arm)).toEqual(["arm.v", "arm.hand.u"]);
});

test("the outermost folded group hides an element", () => {
  const found = tree(elements, [], ["arm", "arm/hand", "gone"], new Set());
  expect(hiddenBy(found, "arm.hand.u")?.key).toBe("arm");
  expect(hiddenBy(found, "top")).toBeNull();
});
