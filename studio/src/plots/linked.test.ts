import { expect, it } from "vitest";
import type { AxisView } from "../protocol";
import { type Coordinate, LinkedCursor, valueOn } from "./linked";

const axis = (name: string, more: Partial<AxisView> = {}): AxisView => ({
  key: name,
  name,
  lower: 0,
  upper: 100,
  samples: 101,
  periodic: false,
  unit: "deg",
  ...more,
});

it("a chart receives the coordinates of other charts, and not its own", () => {
  const cursor = new LinkedCursor();
  const received: string[] = [];
  const [one, other] = [{}, {}];
  cursor.listen(one, (coordinates) => received.push(`one ${coordinates.length}`));
  const end = cursor.listen(other, (coordinates) => received.push(`other ${coordinates.length}`));
  cursor.point(one, [{ along: "time", value: 3 }]);
  cursor.point(other, []);
  end();
  cursor.point(one, []);
  expect(received).toEqual(["other 1", "one 0"]);
});

it("a position has a value on the same axis, also of another sampling, and on no other axis", () => {
  const coordinates: Coordinate[] = [
    { along: axis("x"), value: 30 },
    { along: "time", value: 250 },
  ];
  expect(valueOn(axis("x"), coordinates)).toBe(30);
  expect(valueOn(axis("x", { key: "", samples: 51, upper: 99 }), coordinates)).toBe(30);
  expect(valueOn(axis("x", { unit: "cm" }), coordinates)).toBeNull();
  expect(valueOn(axis("x", { upper: 200 }), coordinates)).toBeNull();
  expect(valueOn(axis("lag in x"), coordinates)).toBeNull();
  expect(valueOn("time", coordinates)).toBe(250);
  expect(valueOn(null, [{ along: null, value: 1 }])).toBeNull();
});
