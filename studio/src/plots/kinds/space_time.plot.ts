// An array along one of its axes as colours over time: time to the right or down, the newest samples or those
// around a moment of the past.

import { edges } from "../../draw/axis";
import { isPicture } from "../../model/ports";
import { scaleOf } from "../../model/mapColors";
import type { PlotDeclaration } from "./kind";
import { axesOf, endsOf, levelsAt, momentMarks, over, spanOf, timeSide } from "./parts";

const MOST = 128;

export const plot: PlotDeclaration = {
  title: "Space-time plot",
  rank: (axes) => (axes.length > 0 && !isPicture(axes) ? 30 : null),
  figure: 1,
  settings: () => ["drawn", "window", "down", "scale", "range"],
  sides: ["Axis over time"],
  ports: (axes) => axes.length > 0 && !isPicture(axes),
  label: (shown) =>
    `${shown.port} of ${shown.element.path} as colours over time and ${over(axesOf(shown), 1)}`,
  file: ({ element, port }) => `${element.path} ${port} over time`,
  wishes: ({ element, port, settings: { drawn, at } }) => [
    { type: "rows", element: element.id, port, most: MOST, drawn: drawn[0] ?? "", at },
  ],
  content: (shown, [live], memory) => {
    const { port, type, settings } = shown;
    const x = live?.form?.axes[0] ?? axesOf(shown)[0];
    if (live === undefined || x === undefined) {
      return null;
    }
    const span = spanOf(shown, endsOf([live.rows.times]));
    const extent = live.rows.extent(span) ?? [];
    const how = scaleOf(settings.scale, type, port);
    const colors = memory.colors(extent, how, levelsAt(shown, port), settings.range);
    const [time, place] = [timeSide(shown, span), { along: x, range: edges(x) }];
    return {
      ...(settings.down ? { x: place, y: time } : { x: time, y: place }),
      marks: [{ type: "rows", label: port, rows: live.rows, colors }, ...momentMarks(shown)],
    };
  },
};
