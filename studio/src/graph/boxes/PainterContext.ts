// The painter of the canvas that shows a live box, and the layer on which it is shown.

import { createContext } from "react";
import { LiveLayer } from "./liveLayer";
import { Painter } from "./painter";

export type Painting = { painter: Painter; layer: LiveLayer };

export function newPainting(): Painting {
  const layer = new LiveLayer();
  return { painter: new Painter(() => layer.paint()), layer };
}

export const PainterContext = createContext(newPainting());
