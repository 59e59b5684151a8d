import type { SerializedDockview } from "dockview-react";
import { expect, it } from "vitest";
import { isArrangement, isChanged, signature } from "./arrangement";

const arrangement = (width: number, left: number, active = "a", title = "A") =>
  ({
    grid: {
      root: {
        type: "branch",
        data: [
          { type: "leaf", size: left, data: { id: "1", views: ["a"], activeView: "a" } },
          { type: "leaf", size: width - left, data: { id: "2", views: ["b"], activeView: "b" } },
        ],
      },
      width,
      height: 500,
      orientation: "HORIZONTAL",
    },
    panels: {
      a: { id: "a", contentComponent: "graph", title },
      b: { id: "b", contentComponent: "plot", params: { element: "u" } },
    },
    activeGroup: active,
  }) as unknown as SerializedDockview;

it("only arrangements of known panels are valid", () => {
  expect(isArrangement(arrangement(1000, 600))).toBe(true);
  expect(isArrangement(undefined)).toBe(false);
  expect(isArrangement({ grid: 1, panels: {} })).toBe(false);
  expect(isArrangement({ grid: {}, panels: { a: { id: "a", contentComponent: "no such thing" } } })).toBe(
    false,
  );
  expect(isArrangement({ grid: {}, panels: { a: { id: "b", contentComponent: "graph" } } })).toBe(false);
});

it("the size of the window, the focus and titles do not change the signature", () => {
  expect(signature(arrangement(1000, 600))).toBe(signature(arrangement(800, 480, "b", "B")));
});

it("a moved border and a changed setting change the signature", () => {
  expect(signature(arrangement(1000, 600))).not.toBe(signature(arrangement(1000, 500)));
  const other = arrangement(1000, 600);
  (other.panels["b"]!.params as Record<string, unknown>)["port"] = "output";
  expect(signature(other)).not.toBe(signature(arrangement(1000, 600)));
});

it("another size of the window changes no arrangement, though it gives panels other shares", () => {
  const found = (width: number, left: number, changed = arrangement(width, left)) => ({
    width,
    height: 500,
    all: signature(changed),
    order: signature(changed, false),
  });
  expect(isChanged(found(1000, 600), found(1000, 500)), "a border was moved").toBe(true);
  expect(isChanged(found(1000, 600), found(640, 240)), "the right panel keeps its width").toBe(false);
  const other = arrangement(640, 240);
  (other.panels["b"]!.params as Record<string, unknown>)["port"] = "output";
  expect(isChanged(found(1000, 600), found(640, 240, other)), "a plot shows another port").toBe(true);
});
