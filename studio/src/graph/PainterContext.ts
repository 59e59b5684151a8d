// The painter of the canvas that a live box stands on, and the layer on which it is shown.

import { createContext } from "react";
import { LiveLayer } from "./liveLayer";
import { Painter } from "./painter";

export type Studio = { painter: Painter; layer: LiveLayer };

export function newStudio(): Studio {
  const layer = new LiveLayer();
  return { painter: new Painter(() => layer.paint()), layer };
}

export const PainterContext = createContext(newStudio());
