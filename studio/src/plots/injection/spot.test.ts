import { expect, it } from "vitest";
import type { AxisView, DocumentView, ElementView } from "../../protocol";
import { spot } from "./spot";

const axis = (key: string, upper: number): AxisView => ({
  key,
  name: key,
  lower: 0,
  upper,
  samples: 11,
  periodic: false,
  unit: "",
});
const AXES = [axis("x", 10), axis("y", 20), axis("hue", 360)];
const element = { id: "a", inputs: ["input"], axes: { input: ["y", "x", "hue"] } } as unknown as ElementView;
const document = { axes: AXES } as unknown as DocumentView;
const how = {
  element,
  document,
  shown: AXES.slice(0, 2).map((shown) => ({ ...shown, key: "" })),
  amplitude: 5,
  width: 0.1,
};

it("the centre has the order of the element's axes; axes that are not drawn are covered whole", () => {
  expect(spot(how, [4, 30])).toEqual({ center: [20, 4, 180], sigma: [2, 1, 36_000], amplitude: 5 });
});

it("an injection into a section has its position", () => {
  expect(spot({ ...how, at: { hue: 90, x: 1 } }, [4, 30])).toEqual({
    center: [20, 4, 90],
    sigma: [2, 1, 36],
    amplitude: 5,
  });
});

it("a uniform injection has no centre", () => {
  expect(spot(how, null)).toEqual({ center: null, sigma: null, amplitude: 5 });
});
