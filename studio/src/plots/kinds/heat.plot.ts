import { isPicture } from "../../model/ports";
import type { PlotDeclaration } from "./plots";

export const plot: PlotDeclaration = {
  title: "Heat map",
  rank: (axes) => (axes.length > 1 && !isPicture(axes) ? 0 : null),
  figure: 2,
  component: "HeatMap",
};
