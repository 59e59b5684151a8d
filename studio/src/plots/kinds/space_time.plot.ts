import { isPicture } from "../../model/ports";
import type { PlotDeclaration } from "./plots";

export const plot: PlotDeclaration = {
  title: "Space-time plot",
  rank: (axes) => (axes.length > 0 && !isPicture(axes) ? 30 : null),
  tab: (name) => `${name} over time`,
  figure: 1,
  component: "SpaceTime",
};
