// The geometry of an axis: positions, steps, extents.

export type Axis = Readonly<{
  name: string;
  unit: string;
  lower: number;
  upper: number;
  samples: number;
  periodic: boolean;
}>;

// Positions of the samples; of fewer values than samples, the middles of equal parts of the axis
// (src/deodar_studio/streams/stream.py).
export function points(axis: Axis, values = axis.samples): Float64Array {
  const [first, last] = edges(axis);
  const step = (last - first) / values;
  return Float64Array.from({ length: values }, (_, i) =>
    values === axis.samples ? axis.lower + i * stepOf(axis) : first + (i + 0.5) * step,
  );
}

// From the outer edge of the cell of the first sample to that of the last.
export function edges(axis: Axis): [number, number] {
  const step = stepOf(axis);
  const last = axis.lower + (axis.samples - 1) * step;
  return [axis.lower - step / 2, last + step / 2];
}

export function stepOf(axis: Axis): number {
  const steps = axis.periodic ? axis.samples : axis.samples - 1;
  return steps > 0 ? (axis.upper - axis.lower) / steps : axis.upper - axis.lower;
}

// Which of `count` equal parts of an axis a position is in.
export function cell(axis: Axis, count: number, position: number): number {
  const [first, last] = edges(axis);
  return Math.min(count - 1, Math.max(0, Math.floor(((position - first) / (last - first)) * count)));
}

// The largest ratio of two axes with the same scale: a longer plot would be a mere strip.
const LONGEST = 8;

// The extents of two axes that have the same scale because they share a unit; null: they do not. A periodic
// axis, such as an angle, has no scale in common with one that is not periodic. Axes without a unit have the
// same scale where their samples are at the same distance.
export function commonScale(x: Axis, y: Axis): [number, number] | null {
  const same = x.unit === y.unit && x.periodic === y.periodic;
  const near = Math.abs(stepOf(x) - stepOf(y)) < 1e-6 * stepOf(x);
  const extents = [x, y].map((axis) => edges(axis)[1] - edges(axis)[0]) as [number, number];
  const ratio = extents[0] / extents[1];
  return same && (x.unit !== "" || near) && ratio < LONGEST && 1 / ratio < LONGEST ? extents : null;
}

export function axisLabel(axis: Axis): string {
  return axis.unit === "" ? axis.name : `${axis.name} (${axis.unit})`;
}

// Whether two axes are the same dimension; axes that were thinned end a little earlier.
export function sameDimension(one: Axis, other: Axis): boolean {
  const near = 0.1 * (one.upper - one.lower);
  return (
    one.name === other.name &&
    one.unit === other.unit &&
    Math.abs(one.lower - other.lower) < near &&
    Math.abs(one.upper - other.upper) < near
  );
}
