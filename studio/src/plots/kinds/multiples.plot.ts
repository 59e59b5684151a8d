import { isPicture } from "../../model/ports";
import type { PlotDeclaration } from "./plots";

export const plot: PlotDeclaration = {
  title: "Small multiples",
  rank: (axes, { several }) => (several && !isPicture(axes) ? 90 : null),
  tab: (name) => `Multiples of ${name}`,
  component: "Multiples",
};
