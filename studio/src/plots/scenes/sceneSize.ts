// The lengths of the box of a scene: the longest side is 1, and axes that share a unit have the same scale.

import type { AxisView } from "../../protocol";
import { commonScale } from "../../draw/axis";
import type { Point3 } from "../../model/sceneView";

const HEIGHT = 0.5;
const VOLUME = 0.8;

// Of a surface, whose height is a value.
export function surfaceSize(x: AxisView, y: AxisView): Point3 {
  const [wide, deep] = commonScale(x, y) ?? [1, 1];
  const longest = Math.max(wide, deep);
  return [wide / longest, deep / longest, HEIGHT];
}

// Of a volume: in one scale where all axes share it.
export function volumeSize(x: AxisView, y: AxisView, z: AxisView): Point3 {
  const [one, other] = [commonScale(x, y), commonScale(x, z)];
  const lengths = one === null || other === null ? [1, 1, 1] : [one[0], one[1], other[1]];
  const longest = Math.max(...lengths);
  return lengths.map((length) => (VOLUME * length) / longest) as [number, number, number];
}
