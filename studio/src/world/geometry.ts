// The geometry of a solid: its own axes are those of the server, z along a capsule or a cylinder.

import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CapsuleGeometry,
  CylinderGeometry,
  PlaneGeometry,
  SphereGeometry,
} from "three";
import type { SolidView } from "../protocol";
import { floatsOf, integersOf } from "../model/base64";

// Half lengths of a plane without an end, in m.
const ENDLESS = 5;

export function geometryOf({ shape, size, points = "", faces = "" }: SolidView): BufferGeometry {
  const [a, b, c] = size as [number, number, number];
  switch (shape) {
    case "plane":
      return new PlaneGeometry(2 * (a || ENDLESS), 2 * (b || ENDLESS));
    case "sphere":
      return new SphereGeometry(a, 32, 16);
    case "ellipsoid":
      return new SphereGeometry(1, 32, 16).scale(a, b, c);
    case "capsule":
      return new CapsuleGeometry(a, 2 * b, 8, 24).rotateX(Math.PI / 2);
    case "cylinder":
      return new CylinderGeometry(a, a, 2 * b, 32).rotateX(Math.PI / 2);
    case "box":
      return new BoxGeometry(2 * a, 2 * b, 2 * c);
    case "mesh":
      return meshGeometry(floatsOf(points), integersOf(faces));
  }
}

// Without shared points, so that every triangle is flat.
function meshGeometry(points: Float32Array, faces: Int32Array): BufferGeometry {
  const made = new BufferGeometry();
  made.setAttribute("position", new BufferAttribute(points, 3));
  made.setIndex(new BufferAttribute(Uint32Array.from(faces), 1));
  const flat = made.toNonIndexed();
  flat.computeVertexNormals();
  made.dispose();
  return flat;
}
