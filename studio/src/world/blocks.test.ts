import { expect, it } from "vitest";

import type { BodyView, SceneView } from "../protocol";
import { blockSide, colourOf, cssColour, inFront } from "./blocks";
import { freeName } from "./planFrame";

const robot: BodyView = { name: "e-puck", x: 0.5, y: 0.5, heading: Math.PI / 2, radius: 0.04 };
const scene: SceneView = { unit: "m", border: [0, 0, 1, 1], boxes: [], marks: [] };
const box = (x: number, y: number) => ({
  name: `${x}`,
  x,
  y,
  width: 0.05,
  height: 0.05,
  color: [0, 0, 0],
  fixed: false,
});

it("a block is placed straight ahead, 1.7 sides in front of the rim", () => {
  const side = blockSide(scene, robot);
  expect(side).toBeCloseTo(0.066);
  const at = inFront(scene, [robot], side);
  expect(at?.x).toBeCloseTo(0.5);
  expect(at?.y).toBeCloseTo(0.5 + 0.04 + 2.2 * 0.066);
});

it("it takes the next distance with room, and none outside the border", () => {
  const side = blockSide(scene, robot);
  const crate = { ...scene, boxes: [box(0.5, 0.72)] };
  expect(inFront(crate, [robot], side)?.y).toBeCloseTo(0.5 + 0.04 + 1.7 * 0.066);
  const near = { ...robot, y: 0.85 };
  expect(inFront(scene, [near], side)?.y).toBeCloseTo(0.85 + 0.04 + 0.066);
  expect(inFront(scene, [{ ...robot, y: 0.96 }], side)).toBeNull();
  expect(
    inFront({ ...scene, marks: [{ name: "goal", x: 0.5, y: 0.7, fixed: false }] }, [robot], side)?.y,
  ).toBeCloseTo(0.5 + 0.04 + 1.7 * 0.066);
});

it("without a robot it is placed in the middle", () => {
  expect(inFront(scene, [], blockSide(scene, undefined))).toEqual({ x: 0.5, y: 0.5 });
});

it("colours are converted from and to the texts of the page", () => {
  expect(colourOf("#ff0080")).toEqual([1, 0, 128 / 255]);
  expect(cssColour([1, 0, 0.5])).toBe("rgb(255 0 128)");
});

it("a block elsewhere gets the next number of its colour", () => {
  const red = { name: "red", color: [1, 0, 0] as [number, number, number] };
  expect(freeName(scene, red.name)).toBe("red 1");
  expect(freeName({ ...scene, boxes: [{ ...box(0, 0), name: "red 1" }] }, red.name)).toBe("red 2");
});
