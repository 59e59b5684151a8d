// The picture of a measured regime: settled activation over the strength of an input, as paths of an SVG.

import type { RegimeCurve } from "../protocol";

export const SIZE = { width: 340, height: 170 };
const MARGIN = { left: 38, right: 8, top: 8, bottom: 34 };

export type CurvePaths = {
  up: string;
  down: string;
  // The threshold of a peak, as a height.
  threshold: number;
  // The ends of both ranges, and their places in the picture.
  x: { at: number; value: number }[];
  y: { at: number; value: number }[];
};

/** Both branches as paths; they part where the field is bistable. */
export function curvePaths(curve: RegimeCurve): CurvePaths {
  const values = [...curve.up, ...curve.down].filter((value) => value !== null);
  const low = Math.min(curve.threshold, ...values);
  const high = Math.max(curve.threshold, ...values);
  const first = curve.input[0] ?? 0;
  const last = curve.input.at(-1) ?? 1;
  const x = (value: number) =>
    MARGIN.left + ((value - first) / (last - first || 1)) * (SIZE.width - MARGIN.left - MARGIN.right);
  const y = (value: number) =>
    SIZE.height -
    MARGIN.bottom -
    ((value - low) / (high - low || 1)) * (SIZE.height - MARGIN.top - MARGIN.bottom);
  const path = (heights: (number | null)[]) => {
    let pen = "M";
    return heights
      .map((value, i) => {
        if (value === null) {
          pen = "M";
          return "";
        }
        const part = `${pen}${x(curve.input[i] ?? 0).toFixed(1)} ${y(value).toFixed(1)}`;
        pen = "L";
        return part;
      })
      .join("");
  };
  return {
    up: path(curve.up),
    down: path(curve.down),
    threshold: y(curve.threshold),
    x: [first, last].map((value) => ({ at: x(value), value })),
    y: [low, high].map((value) => ({ at: y(value), value })),
  };
}
