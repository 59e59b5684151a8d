import { expect, test } from "vitest";
import { squeezed } from "./squeeze";

test("rows without boxes are closed, and all other distances stay", () => {
  const sizes = new Map(["a", "b", "c", "d"].map((id) => [id, { width: 10, height: 50 }]));
  const places = new Map([
    ["c", { x: 0, y: 300 }],
    ["a", { x: 0, y: 0 }],
    ["b", { x: 20, y: 30 }],
    ["d", { x: 20, y: 360 }],
  ]);
  const out = squeezed(places, sizes, 20);
  expect([..."abcd"].map((id) => out.get(id)?.y)).toEqual([0, 30, 100, 160]);
  expect(out.get("c")?.x).toBe(0);
});
