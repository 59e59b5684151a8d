import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { Announced, AxisView, ListedProblem, PlotView } from "../../protocol";
import { paperInk } from "../../draw/ink";
import { attempt, axesOf, load, packagedFrame } from "./packaged";

const PLOT: PlotView = {
  name: "polar",
  title: "Polar plot",
  package: "deodar-change 0.1.0",
  axes: 1,
  periodic: true,
  module: "plots/polar.js",
};
const HEADING: AxisView = {
  key: "heading",
  name: "heading",
  lower: -180,
  upper: 180,
  samples: 8,
  periodic: true,
  unit: "deg",
};
const formOf = (shape: number[], ...axes: AxisView[]): Announced =>
  ({ stream: 1, shape, axes, folded: [], channels: false }) as unknown as Announced;

beforeEach(() => void vi.spyOn(console, "error").mockImplementation(() => undefined));
afterEach(() => vi.restoreAllMocks());

describe("the module of a plot", () => {
  it("is imported from its address and exports draw", async () => {
    const module = { draw: () => undefined };
    const bring = vi.fn(() => Promise.resolve(module));
    expect(await load(PLOT, bring)).toBe(module);
    expect(bring).toHaveBeenCalledWith("plots/polar.js");
  });

  it("is refused without draw, or if dispose is not a function", async () => {
    await expect(load(PLOT, () => Promise.resolve({}))).rejects.toThrow("exports no function draw");
    const wrong = { draw: () => undefined, dispose: 3 };
    await expect(load(PLOT, () => Promise.resolve(wrong))).rejects.toThrow("dispose");
  });

  it("may raise an exception, at once or later, and the message names the package", async () => {
    const told: ListedProblem[] = [];
    const tell = (problem: ListedProblem) => told.push(problem);
    expect(attempt(PLOT, () => undefined, tell)).toBe(true);
    expect(told).toEqual([]);
    const fail = () => {
      throw new RangeError("no radius");
    };
    expect(attempt(PLOT, fail, tell)).toBe(false);
    expect(attempt(PLOT, () => Promise.reject(new Error("too late")), tell)).toBe(true);
    await Promise.resolve();
    expect(told.map((problem) => problem.what)).toEqual([
      'The plot "Polar plot" of the package deodar-change 0.1.0 failed: RangeError: no radius',
      'The plot "Polar plot" of the package deodar-change 0.1.0 failed: Error: too late',
    ]);
  });
});

describe("the values that it draws", () => {
  it("have axes with the positions of the values, also when thinned", () => {
    expect([...(axesOf(formOf([8], HEADING))[0]?.points ?? [])]).toEqual([
      -180, -135, -90, -45, 0, 45, 90, 135,
    ]);
    const [thinned] = axesOf(formOf([3], HEADING));
    expect(thinned?.samples).toBe(3);
    expect([...(thinned?.points ?? [])]).toEqual([-142.5, -22.5, 97.5]);
  });

  it("are a copy, because other plots draw the same values", () => {
    const frame = { stream: 1, frame: 1, time: 20, values: new Float32Array([1, 2]) };
    const given = packagedFrame(formOf([2], HEADING), frame, paperInk(1), {
      width: 300,
      height: 200,
      ratio: 2,
    });
    given.values.fill(0);
    expect([...frame.values]).toEqual([1, 2]);
    expect([given.time, given.width, given.ratio, given.dark]).toEqual([20, 300, 2, false]);
    expect(given.colors.text).toBe("#111111");
    expect(new Set(given.colors.curves).size).toBe(given.colors.curves.length);
  });
});
