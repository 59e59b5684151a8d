import type { PlotDeclaration } from "./plots";

export const plot: PlotDeclaration = {
  title: "Weights",
  rank: (_, { weights }) => (weights ? 80 : null),
  tab: (name) => `Weights of ${name}`,
  component: "Weights",
};
