// The painter of the canvas that a live box stands on.

import { createContext } from "react";
import { Painter } from "./painter";

export const PainterContext = createContext(new Painter());
