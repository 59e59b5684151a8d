// The linked cursor: the position and the time under the mouse pointer in one plot, for all others.

import { sameDimension } from "../draw/axis";
import type { Along } from "../draw/content";

export type Coordinate = { along: Along; value: number };

type Listener = (coordinates: Coordinate[]) => void;

export class LinkedCursor {
  private listeners = new Map<object, Listener>();

  // Show coordinates in all charts but the one that they come from; none: the pointer is in no chart.
  point(source: object, coordinates: Coordinate[]): void {
    for (const [chart, listener] of this.listeners) {
      if (chart !== source) {
        listener(coordinates);
      }
    }
  }

  // The function returned ends it.
  listen(chart: object, listener: Listener): () => void {
    this.listeners.set(chart, listener);
    return () => this.listeners.delete(chart);
  }
}

export const linkedCursor = new LinkedCursor();

// The value of the coordinates on a scale; null where they have none.
export function valueOn(along: Along, coordinates: Coordinate[]): number | null {
  return coordinates.find((other) => isSame(other.along, along))?.value ?? null;
}

function isSame(one: Along, other: Along): boolean {
  if (one === null || other === null || one === "time" || other === "time") {
    return one === other && one !== null;
  }
  return sameDimension(one, other);
}
