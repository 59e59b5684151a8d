import { expect, it } from "vitest";

import type { SceneView } from "../protocol";
import { frameOf, freeName, inside, placeText, toPixels, toWorld, under } from "./planFrame";

const box = (name: string, x: number, y: number, fixed = false) => ({
  name,
  x,
  y,
  width: 0.2,
  height: 0.1,
  color: [0, 0, 0],
  fixed,
});
const scene: SceneView = {
  unit: "m",
  border: [0, -1, 2, 1],
  boxes: [box("crate", 0.5, 0), box("lid", 0.55, 0), box("wall", 1.5, 0.5, true)],
  marks: [{ name: "goal", x: 1, y: 0.5, fixed: false }],
};

it("both axes have one scale, y points upwards, and pixels convert back to positions", () => {
  const frame = frameOf(scene.border, 700, 400);
  const [low, high] = [toPixels(frame, { x: 0, y: -1 }), toPixels(frame, { x: 2, y: 1 })];
  expect(high.x - low.x).toBeCloseTo(low.y - high.y);
  expect(low.x).toBeGreaterThan(40);
  expect(high.y).toBeGreaterThanOrEqual(8);
  expect(low.y).toBeLessThan(400);
  const back = toWorld(frame, toPixels(frame, { x: 0.3, y: -0.4 }));
  expect(back.x).toBeCloseTo(0.3);
  expect(back.y).toBeCloseTo(-0.4);
  expect(inside(frame, { x: 3, y: -5 })).toEqual({ x: 2, y: -1 });
});

it("a panel that is too small has a positive scale", () => {
  expect(frameOf(scene.border, 10, 10).scale).toBeGreaterThan(0);
});

it("the pointer takes the uppermost object, or a mark within some pixels", () => {
  const frame = frameOf(scene.border, 700, 400);
  const found = (x: number, y: number) => under(scene, frame, toPixels(frame, { x, y }))?.name;
  expect(found(0.42, 0)).toBe("crate");
  expect(found(0.55, 0.04)).toBe("lid");
  expect(found(1.5, 0.5)).toBe("wall");
  expect(found(1 + 6 / frame.scale, 0.5)).toBe("goal");
  expect(found(1 + 12 / frame.scale, 0.5)).toBeUndefined();
});

it("positions are shown to a thousandth of the longer side", () => {
  expect(placeText({ x: 0.12345, y: 1 }, [0, 0, 1.2, 0.8], "m")).toBe("0.12, 1.00 m");
  expect(placeText({ x: 12.345, y: 1 }, [0, 0, 120, 80], "cm")).toBe("12, 1 cm");
  expect(placeText({ x: 1, y: 1 }, [0, 0, 5000, 80], "")).toBe("1, 1");
});

it("a new object has an unused name", () => {
  expect(freeName(scene)).toBe("box 1");
  expect(freeName({ ...scene, boxes: [box("box 1", 0, 0), box("box 2", 0, 0)] })).toBe("box 3");
});
