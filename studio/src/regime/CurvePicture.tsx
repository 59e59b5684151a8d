// Settled activation over the strength of a localised input: growing from rest, and falling from a peak.

import type { RegimeCurve } from "../protocol";
import { curvePaths, SIZE } from "./curve";

const rounded = (value: number) => Number(value.toPrecision(3)).toString();

export function CurvePicture({ curve, words }: { curve: RegimeCurve; words: string }) {
  const { up, down, threshold, x, y } = curvePaths(curve);
  return (
    <figure className="regime-curve">
      <svg
        viewBox={`0 0 ${SIZE.width} ${SIZE.height}`}
        role="img"
        aria-label={`Settled activation: ${words}`}
      >
        <line className="regime-threshold" x1={x[0]?.at} x2={x[1]?.at} y1={threshold} y2={threshold} />
        <path className="regime-down" d={down} />
        <path className="regime-up" d={up} />
        {x.map(({ at, value }, i) => (
          <text key={i} x={at} y={SIZE.height - 20} textAnchor={i === 0 ? "start" : "end"}>
            {rounded(value)}
          </text>
        ))}
        {y.map(({ at, value }, i) => (
          <text key={i} x={x[0] === undefined ? 0 : x[0].at - 5} y={at + 4} textAnchor="end">
            {rounded(value)}
          </text>
        ))}
        <text x={SIZE.width / 2} y={SIZE.height - 5} textAnchor="middle">
          strength of a localised input
        </text>
      </svg>
      <figcaption>
        Settled activation at its maximum: <span className="regime-key-up">input grows</span>,{" "}
        <span className="regime-key-down">input falls</span>. Where both part, the field is bistable. Dotted:
        the threshold.
      </figcaption>
    </figure>
  );
}
