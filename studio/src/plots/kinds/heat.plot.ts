// A port over two axes as colours; with more axes a section at positions on the others, or the maximum over
// them.

import { isPicture } from "../../model/ports";
import { scaleOf } from "../../model/mapColors";
import type { PlotDeclaration } from "./kind";
import { axesOf, levelsAt, over, planeContent } from "./parts";

const MOST = 256;

export const plot: PlotDeclaration = {
  title: "Heat map",
  rank: (axes) => (axes.length > 1 && !isPicture(axes) ? 0 : null),
  figure: 2,
  settings: () => ["drawn", "scale", "range", "push"],
  sides: ["To the right", "Upwards"],
  ports: (axes) => axes.length > 1,
  label: (shown) => `${shown.port} of ${shown.element.path} as colours over ${over(axesOf(shown), 2)}`,
  file: ({ element, port }) => `${element.path} ${port}`,
  wishes: ({ element, port, settings: { drawn, at } }) => [
    { type: "watch", element: element.id, port, most: MOST, drawn, at },
  ],
  content: (shown, [live], memory) =>
    planeContent(shown.document, live, shown.port, (values) =>
      memory.colors(
        values,
        scaleOf(shown.settings.scale, shown.type, shown.port),
        levelsAt(shown, shown.port),
        shown.settings.range,
      ),
    ),
};
