// The interaction kernel of an element over the lag between two positions, with its parameters as they are
// now: a curve over one axis, colours over two.

import { points } from "../../draw/axis";
import { extent } from "../../draw/scale";
import { chosenScale } from "../../model/mapColors";
import type { PlotDeclaration } from "./kind";
import { line, planeContent, portPaint } from "./parts";

const MOST = 600;

export const plot: PlotDeclaration = {
  title: "Interaction kernel",
  rank: (axes, { kernel }) => (kernel && axes.length > 0 ? 70 : null),
  settings: () => ["range"],
  label: ({ element }) => `Interaction kernel of ${element.path}`,
  file: ({ element }) => `${element.path} kernel`,
  note: () => "interaction kernel",
  wishes: ({ element }) => [{ type: "kernel", element: element.id, most: MOST }],
  content: (shown, [live], memory) => {
    const { range } = shown.settings;
    const [x, y] = live?.form?.axes ?? [];
    const values = live?.frame?.values;
    if (x === undefined || values === undefined) {
      return null;
    }
    if (y !== undefined) {
      const how = chosenScale("diverging");
      return planeContent(shown.document, live, "weight", () => memory.colors(values, how, [], range));
    }
    const curve = line("weight", portPaint("interaction", ["interaction"]), points(x, values.length), values);
    return {
      x: { along: x, range: [x.lower, x.upper] },
      y: {
        along: null,
        label: "weight",
        range: memory.around(extent(values), { include: [0], fixed: range }),
      },
      marks: [{ ...curve, width: 2 }],
    };
  },
};
