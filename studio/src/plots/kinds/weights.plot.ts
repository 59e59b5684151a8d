// The weights of an element that do not learn: an array parameter from a source to a target as colours, white
// at 0. Weights that learn are a port.

import { weightsOf } from "../../model/ports";
import { chosenScale } from "../../model/mapColors";
import type { PlotDeclaration, Shown } from "./kind";
import { axesOf, over, planeContent } from "./parts";

const MOST = 256;

export const plot: PlotDeclaration = {
  title: "Weights",
  rank: (_, { weights }) => (weights ? 80 : null),
  settings: () => ["drawn", "scale", "range"],
  sides: ["To the right", "Upwards"],
  label: (shown) => {
    const { name, ports } = parameter(shown);
    return `${name} of ${shown.element.path} as colours over ${over(axesOf(shown, ports), 2)}`;
  },
  file: (shown) => `${shown.element.path} ${parameter(shown).name}`,
  note: (shown) => {
    const { name, ports } = parameter(shown);
    return `${name} over ${ports.join(" and ")}`;
  },
  wishes: (shown) => {
    const { drawn, at } = shown.settings;
    const { name } = parameter(shown);
    return [{ type: "weights", element: shown.element.id, parameter: name, most: MOST, drawn, at }];
  },
  content: (shown, [live], memory) => {
    const { scale, range } = shown.settings;
    const how = chosenScale(scale === "auto" ? "diverging" : scale);
    return planeContent(shown.document, live, parameter(shown).name, (values) =>
      memory.colors(values, how, [], range),
    );
  },
};

function parameter({ document, element, type }: Shown) {
  return weightsOf(document, element, type)[0] ?? { name: "", ports: [] };
}
