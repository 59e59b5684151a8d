import { existsSync } from "node:fs";

import { describe, expect, it } from "vitest";
import type { AxisView, DocumentView, ElementView, Kind, PlotView } from "../../protocol";
import { axisLabel, cell, commonScale, edges, points, stepOf } from "../../draw/axis";
import {
  elementsAlike,
  firstToPlot,
  fits,
  isPicture,
  mainPort,
  portAxes,
  portsAlike,
  runsDown,
  weightsOf,
} from "../../model/ports";
import { hasFigure, PLOTS, plotKinds, titleOf } from "./plots";

const axis = (key: string, samples = 11, more: Partial<AxisView> = {}): AxisView => ({
  key,
  name: key,
  lower: 0,
  upper: 10,
  samples,
  periodic: false,
  unit: "",
  ...more,
});

const AXES = [
  axis("x"),
  axis("y"),
  axis("hue", 12, { periodic: true, upper: 360, unit: "deg" }),
  axis("channel", 3),
];

const element = (
  id: string,
  kind: string,
  axes: Record<string, string[]>,
  inputs: string[] = [],
): ElementView => ({
  id,
  path: id,
  name: id,
  group: [],
  kind,
  every: 1,
  values: {},
  inputs,
  outputs: Object.keys(axes).filter((port) => !inputs.includes(port)),
  axes,
  pushable: false,
  kernel: false,
  effect: "+",
  strength: "",
});

const documentOf = (...elements: ElementView[]) => ({ axes: AXES, elements }) as unknown as DocumentView;

const LEVELLED = { levels: { charge: { threshold: "theta" } } } as unknown as Kind;

const KNOWN = new Set(
  "course curve heat picture space_time phase surface volume kernel weights multiples odd".split(" "),
);

// The kinds that are offered, of those that these tests know.
const offered: typeof plotKinds = (...given) => plotKinds(...given).filter((kind) => KNOWN.has(kind));

describe("kinds of plots", () => {
  it("follow from the axes", () => {
    const [x, y, hue, channel] = AXES as [AxisView, AxisView, AxisView, AxisView];
    expect(offered(null)).toEqual(["course", "phase"]);
    expect(offered([])).toEqual(["course", "phase"]);
    expect(offered([x])).toEqual(["curve", "course", "space_time", "phase"]);
    expect(offered([x, y])).toEqual(["heat", "course", "curve", "space_time", "phase", "surface"]);
    expect(offered([x, y, hue])).toEqual([
      "heat",
      "course",
      "curve",
      "space_time",
      "phase",
      "surface",
      "volume",
    ]);
    expect(offered([x, y, channel])).toEqual(["picture", "course"]);
    expect(offered([x], [], { weights: true })).toContain("weights");
    expect(offered(null, [], { weights: true })).toContain("weights");
    expect(isPicture([x, y, { ...channel, samples: 4 }])).toBe(false);
    expect(offered([x], [], { kernel: true })).toEqual(["curve", "course", "space_time", "phase", "kernel"]);
  });

  it("show several elements with the same port over the same axes side by side", () => {
    const [x] = AXES as [AxisView];
    const [one, other] = [element("a", "k", { output: ["x"] }), element("b", "k", { output: ["x"] })];
    const document = documentOf(
      one,
      other,
      element("c", "k", { output: ["y"] }),
      element("d", "k", { sum: ["x"] }),
    );
    expect(elementsAlike(document, one, "output").map(({ id }) => id)).toEqual(["a", "b"]);
    expect(offered([x], [], { several: true })).toContain("multiples");
    expect(offered([], [], { several: true })).toContain("multiples");
    expect(offered([x])).not.toContain("multiples");
  });

  it("of packages come last, where the axes fit", () => {
    const [x, y, hue, channel] = AXES as [AxisView, AxisView, AxisView, AxisView];
    const plot = (axes: number, periodic = false) =>
      ({ name: "odd", title: "Odd", axes, periodic }) as PlotView;
    expect(offered([hue], [plot(1)])).toEqual(["curve", "course", "space_time", "phase", "odd"]);
    expect(offered([x, y], [plot(1)])).not.toContain("odd");
    expect([[], [x], [x, y], [x, y, hue], [x, y, channel]].map((axes) => fits(plot(2), axes))).toEqual([
      false,
      false,
      true,
      true,
      false,
    ]);
    expect([[x], [x, y, hue], [x, y, channel]].map((axes) => fits(plot(3), axes))).toEqual([
      false,
      false,
      true,
    ]);
    expect([[x], [hue]].map((axes) => fits(plot(1, true), axes))).toEqual([false, true]);
  });

  it("of weights need an array parameter over two axes or more", () => {
    const type = { maps: { weights: ["output", "input"] } } as unknown as Kind;
    const map = element("a", "k", { output: ["x"], input: ["y"] }, ["input"]);
    expect(weightsOf(documentOf(map), map, type)).toEqual([{ name: "weights", ports: ["output", "input"] }]);
    expect(weightsOf(documentOf(map), map, undefined)).toEqual([]);
    const row = element("b", "k", { output: [], input: ["y"] }, ["input"]);
    expect(weightsOf(documentOf(row), row, type)).toEqual([]);
  });

  it("in three dimensions have a component among the scenes", () => {
    const scenes = [...PLOTS.values()].flatMap((plot) => ("component" in plot ? [plot.component] : []));
    for (const component of scenes) {
      expect(existsSync(new URL(`../scenes/${component}.tsx`, import.meta.url)), component).toBe(true);
    }
    expect(scenes).toHaveLength(2);
  });

  it("have the titles of the page or of the package", () => {
    const polar = { name: "polar", title: "Polar plot" } as PlotView;
    expect(titleOf("heat", [polar])).toBe("Heat map");
    expect(titleOf("polar", [polar])).toBe("Polar plot");
    expect(PLOTS.has("heat") && !PLOTS.has("polar")).toBe(true);
  });

  it("have no axes if the document states none", () => {
    const one = element("a", "k", { output: ["x", "lost"] });
    expect(portAxes(documentOf(one), one, "output")).toBeNull();
    expect(portAxes(documentOf(one), one, "other")).toBeNull();
  });

  it("put ports over the same axes into one plot", () => {
    const one = element("a", "k", { output: ["x"], state: ["x"], total: [], input: ["x"] }, ["input"]);
    expect(portsAlike(one, "output")).toEqual(["output", "state", "input"]);
    expect(portsAlike(one, "total")).toEqual(["total"]);
  });
});

describe("figure files", () => {
  it("are offered for plots that deodar plot draws in the same way", () => {
    expect(["course", "curve", "space_time"].every((kind) => hasFigure(kind, 1))).toBe(true);
    expect(["course", "heat"].every((kind) => hasFigure(kind, 2))).toBe(true);
    expect(["kernel", "phase", "ridges"].some((kind) => hasFigure(kind, 1))).toBe(false);
  });

  it("are not offered for sections, which figures do not have", () => {
    expect(["curve", "space_time"].some((kind) => hasFigure(kind, 2))).toBe(false);
    expect(hasFigure("heat", 3)).toBe(false);
  });
});

describe("the first plot", () => {
  it("shows the port with levels", () => {
    expect(mainPort(element("a", "k", { output: [], charge: [] }), LEVELLED)).toBe("charge");
    expect(mainPort(element("a", "k", { output: [], other: [] }), undefined)).toBe("output");
    expect(mainPort(element("a", "k", {}), undefined)).toBe("");
  });

  it("shows the element with levels and most axes, at most two", () => {
    const kinds = new Map([["cell", LEVELLED]]);
    const plain = element("plain", "source", { output: ["x", "y"] });
    const node = element("node", "cell", { output: [], charge: [] });
    const line = element("line", "cell", { output: ["x"], charge: ["x"] });
    const deep = element("deep", "cell", { charge: ["x", "y", "hue"] });
    expect(firstToPlot(documentOf(plain, node, line, deep), kinds)?.id).toBe("line");
    expect(firstToPlot(documentOf(plain), kinds)).toBeNull();
  });
});

describe("axes", () => {
  it("have the sample positions of the server", () => {
    expect([...points(axis("x", 3))]).toEqual([0, 5, 10]);
    expect([...points(axis("x", 11), 2)]).toEqual([2.25, 7.75]);
    expect([...points(axis("x", 4, { periodic: true, upper: 8 }))]).toEqual([0, 2, 4, 6]);
    expect(stepOf(axis("x", 1, { periodic: true }))).toBe(10);
  });

  it("have cells around their samples", () => {
    expect(edges(axis("x", 11))).toEqual([-0.5, 10.5]);
    expect([-3, 4.4, 4.6, 20].map((value) => cell(axis("x", 11), 11, value))).toEqual([0, 4, 5, 10]);
  });

  it("have one scale if they share a unit", () => {
    const mm = (samples: number, upper: number) => axis("x", samples, { upper, unit: "mm" });
    expect(commonScale(mm(11, 10), mm(41, 20))).toEqual([11, 20.5]);
    expect(commonScale(mm(11, 10), axis("y", 11, { unit: "deg" }))).toBeNull();
    expect(commonScale(mm(11, 10), mm(11, 1000)), "a strip").toBeNull();
    const angle = axis("hue", 36, { upper: 360, unit: "deg", periodic: true });
    expect(commonScale(axis("x", 11, { upper: 100, unit: "deg" }), angle)).toBeNull();
    expect(commonScale(axis("x", 11), axis("y", 11))).toEqual([11, 11]);
    expect(commonScale(axis("x", 11), axis("y", 5)), "other distances").toBeNull();
  });

  it("are named with their unit", () => {
    expect(axisLabel(axis("x"))).toBe("x");
    expect(axisLabel(axis("x", 3, { unit: "deg" }))).toBe("x (deg)");
  });

  it("run downwards if they are rows of a picture", () => {
    const eye = element("eye", "k", { output: ["x", "y", "channel"] });
    expect(runsDown(documentOf(eye), axis("y", 5))).toBe(true);
    expect(runsDown(documentOf(eye), axis("x"))).toBe(false);
    expect(runsDown(documentOf(), axis("y"))).toBe(false);
  });
});
