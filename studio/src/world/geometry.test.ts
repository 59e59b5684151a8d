import { expect, it } from "vitest";

import type { SolidView } from "../protocol";
import { geometryOf } from "./geometry";

const solid = (shape: SolidView["shape"], size: number[], more: Partial<SolidView> = {}): SolidView => ({
  body: "thing",
  shape,
  size,
  color: [1, 0, 0, 1],
  thing: "",
  pushable: false,
  ...more,
});

const base64 = (array: Float32Array | Int32Array) => Buffer.from(array.buffer).toString("base64");

it.each<[SolidView["shape"], number[], number[]]>([
  ["box", [1, 2, 3], [1, 2, 3]],
  ["sphere", [2, 0, 0], [2, 2, 2]],
  ["ellipsoid", [1, 2, 3], [1, 2, 3]],
  ["cylinder", [1, 3, 0], [1, 1, 3]],
  ["capsule", [1, 3, 0], [1, 1, 4]],
  ["plane", [2, 3, 0.1], [2, 3, 0]],
])("a %s has its half lengths along its own axes", (shape, size, half) => {
  const made = geometryOf(solid(shape, size));
  made.computeBoundingBox();
  made.boundingBox?.max.toArray().forEach((value, d) => expect(value).toBeCloseTo(half[d] as number, 5));
});

it("a mesh has its triangles, and each of them its own normal", () => {
  const points = base64(Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]));
  const faces = base64(Int32Array.from([0, 2, 1, 0, 1, 3]));
  const made = geometryOf(solid("mesh", [0, 0, 0], { points, faces }));
  expect(made.getAttribute("position").count).toBe(6);
  const normals = made.getAttribute("normal");
  expect([normals.getX(0), normals.getY(0), normals.getZ(0)]).toEqual([0, 0, -1]);
  expect([normals.getX(3), normals.getY(3), normals.getZ(3)]).toEqual([0, -1, 0]);
});
