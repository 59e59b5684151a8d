import { isPicture } from "../../model/ports";
import type { PlotDeclaration } from "./plots";

export const plot: PlotDeclaration = {
  title: "Phase plot",
  rank: (axes) => (isPicture(axes) ? null : 40),
  tab: (name) => `Phase of ${name}`,
  component: "Phase",
};
