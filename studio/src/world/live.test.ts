import { expect, it } from "vitest";

import { LiveWorld } from "./live";

it("the path grows, restarts on a message of the server, and React renders only static parts", () => {
  const live = new LiveWorld();
  let told = 0;
  const end = live.listen(() => told++);
  live.take({ type: "scene", scene: { unit: "m", border: [0, 0, 1, 1], boxes: [], marks: [] } });
  const before = live.scene();
  live.take({ type: "bodies", bodies: [], fresh: true, way: [[0, 0]] });
  live.take({
    type: "bodies",
    bodies: [],
    fresh: false,
    way: [
      [1, 0],
      [2, 0],
    ],
  });
  expect(live.now.way).toEqual([
    [0, 0],
    [1, 0],
    [2, 0],
  ]);
  expect(live.scene()).toBe(before);
  live.take({ type: "bodies", bodies: [], fresh: true, way: [[5, 5]] });
  expect(live.now.way).toEqual([[5, 5]]);
  end();
  live.take({ type: "scene", scene: null });
  expect([told, live.scene()]).toEqual([4, null]);
});
