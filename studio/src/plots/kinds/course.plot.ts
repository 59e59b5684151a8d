import type { PlotDeclaration } from "./plots";

export const plot: PlotDeclaration = {
  title: "Time course",
  rank: () => 10,
  tab: (name) => `${name} over time`,
  figure: Number.POSITIVE_INFINITY,
  component: "TimeCourse",
};
