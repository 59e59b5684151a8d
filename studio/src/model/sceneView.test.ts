import { expect, it } from "vitest";
import { FIRST_VIEW, projection, turned, zoomed } from "./sceneView";

it("the origin is in the middle, and the third axis runs upwards", () => {
  const project = projection(FIRST_VIEW, 400, 300);
  expect(project([0, 0, 0])).toEqual([200, 150]);
  const [x, y] = project([0, 0, 0.5]);
  expect(x).toBeCloseTo(200);
  expect(y).toBeLessThan(150);
});

it("from above the first axis runs to the right and the second one upwards", () => {
  const project = projection({ azimuth: -90, elevation: 90, zoom: 1 }, 400, 300);
  const [x, y] = project([0.5, 0.25, 0]);
  expect(x).toBeGreaterThan(200);
  expect(y).toBeLessThan(150);
  expect((x - 200) / (150 - y)).toBeCloseTo(2);
});

it("what is nearer is larger, and a narrow plot shows everything smaller", () => {
  const view = { azimuth: 0, elevation: 0, zoom: 1 };
  const wide = (point: [number, number, number]) => projection(view, 400, 300)(point)[0] - 200;
  expect(wide([0.5, 0.5, 0])).toBeGreaterThan(wide([-0.5, 0.5, 0]));
  expect(projection(view, 150, 300)([0, 0.5, 0])[0] - 75).toBeCloseTo(wide([0, 0.5, 0]) / 2);
});

it("the view turns with the pointer, and ends at the top", () => {
  expect(turned({ azimuth: -179, elevation: 80, zoom: 1 }, 10, 40)).toEqual({
    azimuth: 176,
    elevation: 90,
    zoom: 1,
  });
  expect(zoomed(FIRST_VIEW, 100).zoom).toBe(8);
});
