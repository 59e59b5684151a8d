// A push of a body with the mouse: a spring between the point that was gripped and the pointer.

import type { Point3 } from "../model/sceneView";

// Of the spring, in N/m, and its largest force in N: guesses, with which an arm yields by some centimetres.
const STIFFNESS = 400;
const MOST = 100;

// The force of the spring from the gripped point towards the pointer.
export function force(grip: Point3, pointer: Point3): Point3 {
  const pull = pointer.map((value, d) => STIFFNESS * (value - (grip[d] as number)));
  const size = Math.hypot(...pull);
  return pull.map((value) => value * Math.min(1, MOST / Math.max(size, 1e-9))) as unknown as Point3;
}
