// Settled activation over the strength of a localised input: growing from rest, and falling from a peak.

import { useEffect, useRef } from "react";
import type { Drawing } from "../plots/Drawing";
import { DrawingPlace } from "../plots/DrawingPlace";
import type { RegimeCurve } from "../protocol";
import { curveContent } from "./curve";

export function CurvePicture({ curve, words }: { curve: RegimeCurve; words: string }) {
  const drawing = useRef<Drawing | null>(null);
  useEffect(() => drawing.current?.show(curveContent(curve)));
  const keep = (made: Drawing | null) => {
    drawing.current = made;
  };
  return (
    <figure className="regime-curve">
      <div className="regime-drawing">
        <DrawingPlace label={`Settled activation: ${words}`} injection={null} keep={keep} />
      </div>
      <figcaption className="fine">
        Settled activation at its maximum: <span className="regime-key-up">input grows</span>,{" "}
        <span className="regime-key-down">input falls</span>. Where both part, the field is bistable.
      </figcaption>
    </figure>
  );
}
