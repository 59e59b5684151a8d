import { expect, it } from "vitest";

import { LiveWorld } from "./live";

it("the picture of a world stays the same object, and its pixels change", () => {
  const live = new LiveWorld();
  const scene = { unit: "servo", border: [0, 0, 1, 1], boxes: [], marks: [] };
  const picture = { name: "events", columns: 2, rows: 1 };
  live.take({ type: "scene", scene, picture });
  const before = live.picture();
  expect(before).toEqual(picture);
  live.take({ type: "bodies", bodies: [], fresh: true, path: [], picture: btoa("abcdef") });
  expect([...live.now.pixels]).toEqual([97, 98, 99, 100, 101, 102]);
  live.take({ type: "scene", scene, picture: { ...picture } });
  expect(live.picture()).toBe(before);
  live.take({ type: "scene", scene });
  expect(live.picture()).toBe(null);
});

it("the path grows and restarts with messages of the server, and static parts stay the same object", () => {
  const live = new LiveWorld();
  let calls = 0;
  const end = live.listen(() => calls++);
  live.take({ type: "scene", scene: { unit: "m", border: [0, 0, 1, 1], boxes: [], marks: [] } });
  const before = live.scene();
  live.take({ type: "bodies", bodies: [], fresh: true, path: [[0, 0]] });
  live.take({
    type: "bodies",
    bodies: [],
    fresh: false,
    path: [
      [1, 0],
      [2, 0],
    ],
  });
  expect(live.now.path).toEqual([
    [0, 0],
    [1, 0],
    [2, 0],
  ]);
  expect(live.scene()).toBe(before);
  live.take({ type: "bodies", bodies: [], fresh: true, path: [[5, 5]] });
  expect(live.now.path).toEqual([[5, 5]]);
  end();
  live.take({ type: "scene", scene: null });
  expect([calls, live.scene()]).toEqual([4, null]);
});
