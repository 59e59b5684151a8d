import { expect, test } from "vitest";

import { fakeDocument, fakeElement } from "../architecture/fakes";
import type { AxisView } from "../protocol";
import { axesOver, newAxis } from "./elementAxes";

const axis = (key: string, name = key): AxisView => ({
  key,
  name,
  lower: 0,
  upper: 10,
  samples: 11,
  periodic: false,
  unit: "",
});
const over = (path: string, ...axes: string[]) => fakeElement(path, "Field", { values: { axes } });
const names = (chosen: ReturnType<typeof axesOver>) =>
  chosen.map((one) => (typeof one === "string" ? one : `new ${one.name}`));

test("a new axis has a free name, whatever the keys are", () => {
  expect(newAxis([]).name).toBe("x");
  expect(newAxis([axis("x"), axis("y_2", "y")]).name).toBe("z");
  expect(newAxis(["x", "y", "z", "w", "x1"].map((name) => axis(name))).name).toBe("x2");
});

test("without axes a new element brings its own, of fewer samples the more they are", () => {
  const empty = fakeDocument([]);
  expect([1, 2, 3].map((count) => names(axesOver(count, empty)))).toEqual([
    ["new x"],
    ["new x", "new y"],
    ["new x", "new y", "new z"],
  ]);
  const samples = [1, 2, 3].map((count) => {
    const [first] = axesOver(count, empty);
    return typeof first === "object" ? first.samples : 0;
  });
  expect(samples).toEqual([101, 51, 21]);
});

test("axes of an element over as many dimensions are taken, else those that are there, and new ones", () => {
  const axes = [axis("x"), axis("y"), axis("channel")];
  const document = fakeDocument([over("eye", "x", "y", "channel"), over("u", "x"), over("v", "y", "x")], [], {
    axes,
  });
  expect(names(axesOver(1, document))).toEqual(["x"]);
  expect(names(axesOver(2, document))).toEqual(["y", "x"]);
  expect(names(axesOver(3, document)), "no picture").toEqual(["y", "x", "new z"]);
  expect(names(axesOver(2, fakeDocument([over("u", "x")], [], { axes })))).toEqual(["x", "new z"]);
  expect(names(axesOver(1, fakeDocument([over("v", "y", "x")], [], { axes })))).toEqual(["y"]);
  expect(names(axesOver(2, fakeDocument([], [], { axes }))), "those that no element has yet").toEqual([
    "x",
    "y",
  ]);
});
