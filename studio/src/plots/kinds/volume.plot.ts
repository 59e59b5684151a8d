import { isPicture } from "../../model/ports";
import type { PlotDeclaration } from "./kind";

export const plot: PlotDeclaration = {
  title: "Volume slices",
  rank: (axes) => (axes.length > 2 && !isPicture(axes) ? 60 : null),
  component: "Volume",
};
