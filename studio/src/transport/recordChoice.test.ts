import { expect, it } from "vitest";
import type { ElementView } from "../protocol";
import { findPorts, toggled } from "./recordChoice";

const field = { id: "a", path: "scene.u", outputs: ["activation", "output"], inputs: ["input"] } as unknown;
const stimulus = { id: "b", path: "left", outputs: ["output"], inputs: [] as string[] } as unknown;
const elements = [field, stimulus] as ElementView[];

it("ports are found by element and port, and ticked ones come first", () => {
  expect(findPorts(elements, [], "").map(({ element, port }) => `${element} ${port}`)).toEqual([
    "a activation",
    "a output",
    "a input",
    "b output",
  ]);
  const ticked = [{ element: "b", port: "output" }];
  expect(findPorts(elements, ticked, " OUT ").map(({ element }) => element)).toEqual(["b", "a"]);
  expect(findPorts(elements, ticked, "scene.u.in")).toEqual([{ element: "a", port: "input" }]);
});

it("a port is ticked and cleared again", () => {
  const once = toggled([], { element: "a", port: "input" });
  expect(once).toEqual([{ element: "a", port: "input" }]);
  expect(toggled(once, { element: "a", port: "output" })).toHaveLength(2);
  expect(toggled(once, { element: "a", port: "input" })).toEqual([]);
});
