import { isPicture } from "../../model/ports";
import type { PlotDeclaration } from "./plots";

export const plot: PlotDeclaration = {
  title: "Curves",
  rank: (axes) => (axes.length === 1 ? 0 : axes.length > 1 && !isPicture(axes) ? 20 : null),
  figure: 1,
  component: "FieldCurve",
};
