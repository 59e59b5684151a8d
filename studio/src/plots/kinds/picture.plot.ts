import { isPicture } from "../../model/ports";
import type { PlotDeclaration } from "./plots";

export const plot: PlotDeclaration = {
  title: "Picture",
  rank: (axes) => (isPicture(axes) ? 0 : null),
  figure: 3,
  component: "Picture",
};
