import type { PlotDeclaration } from "./plots";

export const plot: PlotDeclaration = {
  title: "Interaction kernel",
  rank: (axes, { kernel }) => (kernel && axes.length > 0 ? 70 : null),
  tab: (name) => `Kernel of ${name}`,
  component: "Kernel",
};
