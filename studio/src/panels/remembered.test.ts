import type { SerializedDockview } from "dockview-react";
import { expect, it } from "vitest";
import { restored } from "./remembered";

const leaf = (id: string, size: number, views = [id], activeView = id) => ({
  type: "leaf",
  size,
  data: { id, views, activeView },
});
const branch = (...data: unknown[]) => ({ type: "branch", size: 500, data });
const arrangement = (root: unknown) =>
  ({
    grid: { root, width: 1000, height: 500, orientation: "HORIZONTAL" },
    panels: {},
  }) as unknown as SerializedDockview;

it("the same groups get back their sizes, with the tab that is in front now", () => {
  const before = arrangement(branch(leaf("a", 600, ["a", "c"]), leaf("b", 400)));
  const now = arrangement(branch(leaf("a", 700, ["a", "c"], "c"), leaf("b", 300)));
  expect(restored(before, now)?.grid.root).toEqual(branch(leaf("a", 600, ["a", "c"], "c"), leaf("b", 400)));
});

it("a branch around everything that was left behind does not count", () => {
  const before = arrangement(branch(leaf("a", 300), leaf("b", 200)));
  const now = arrangement(branch(branch(leaf("a", 200), leaf("b", 300))));
  expect(restored(before, now)?.grid).toEqual(before.grid);
});

it("other groups, or others in a group, keep the arrangement as it is", () => {
  const before = arrangement(branch(leaf("a", 600), leaf("b", 400)));
  expect(restored(before, arrangement(branch(leaf("a", 600), leaf("c", 400))))).toBeNull();
  expect(restored(before, arrangement(branch(leaf("a", 600, ["a", "c"]), leaf("b", 400))))).toBeNull();
});
