import { isPicture } from "../../model/ports";
import type { PlotDeclaration } from "./kind";

export const plot: PlotDeclaration = {
  title: "Surface",
  rank: (axes) => (axes.length > 1 && !isPicture(axes) ? 50 : null),
  component: "Surface",
};
