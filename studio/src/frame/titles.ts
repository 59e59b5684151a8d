// The titles of what the views show beside plots.

export const TITLES = {
  graph: "Architecture",
  palette: "Elements",
  experiment: "Experiment",
  world: "World",
};
