// The view of a box in three dimensions: where its points are on the screen. The box is around the origin,
// its longest side has the length 1, and the third axis runs upwards.

export type Point3 = readonly [number, number, number];

// The direction to the camera, in degrees, and a magnification.
export type Viewpoint = { azimuth: number; elevation: number; zoom: number };

export const FIRST_VIEW: Viewpoint = { azimuth: -60, elevation: 30, zoom: 1 };

// Of the camera: its distance from the origin, and the vertical angle that it sees.
export const DISTANCE = 4;
export const ANGLE = 22;

const RADIANS = Math.PI / 180;

// The position of the camera.
export function cameraAt({ azimuth, elevation }: Viewpoint): Point3 {
  const [a, e] = [azimuth * RADIANS, elevation * RADIANS];
  return [DISTANCE * Math.cos(e) * Math.cos(a), DISTANCE * Math.cos(e) * Math.sin(a), DISTANCE * Math.sin(e)];
}

// Pixels above and below the box, for names and numbers.
const AROUND = 28;

// How much the camera magnifies: a narrow or low plot shows the box smaller.
export function magnification({ zoom }: Viewpoint, width: number, height: number): number {
  return zoom * Math.min(1, width / height) * Math.max(0.4, 1 - (2 * AROUND) / height);
}

// A function that takes points to pixels, from the top left.
export function projection(
  view: Viewpoint,
  width: number,
  height: number,
): (point: Point3) => [number, number] {
  const [a, e] = [view.azimuth * RADIANS, view.elevation * RADIANS];
  const right: Point3 = [-Math.sin(a), Math.cos(a), 0];
  const up: Point3 = [-Math.sin(e) * Math.cos(a), -Math.sin(e) * Math.sin(a), Math.cos(e)];
  const camera = cameraAt(view);
  const length = (height / 2 / Math.tan((ANGLE / 2) * RADIANS)) * magnification(view, width, height);
  return (point) => {
    const depth = DISTANCE - dot(point, camera) / DISTANCE;
    return [width / 2 + (length * dot(point, right)) / depth, height / 2 - (length * dot(point, up)) / depth];
  };
}

// The view after the pointer has moved by pixels.
export function turned(view: Viewpoint, across: number, down: number): Viewpoint {
  const elevation = Math.min(90, Math.max(-90, view.elevation + 0.5 * down));
  return { ...view, azimuth: ((((view.azimuth - 0.5 * across + 180) % 360) + 360) % 360) - 180, elevation };
}

export function zoomed(view: Viewpoint, factor: number): Viewpoint {
  return { ...view, zoom: Math.min(8, Math.max(0.3, view.zoom * factor)) };
}

function dot(one: Point3, other: Point3): number {
  return one[0] * other[0] + one[1] * other[1] + one[2] * other[2];
}
