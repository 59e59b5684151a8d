// Plots of installed packages: the calls of their ES modules. The manual (Adding an
// element) describes the interface of a module.

import type { Announced, ListedProblem, PlotView } from "../../protocol";
import type { Frame } from "../../server/frames";
import { curveColor } from "../../model/colors";
import { points } from "../../draw/axis";
import type { Ink } from "../../draw/ink";

// What a module receives for each drawing.
export type PackagedFrame = {
  // The last axis changes fastest; the plot may write to them.
  values: Float32Array;
  shape: number[];
  axes: PackagedAxis[];
  // Names of the axes over which the maximum is taken.
  folded: string[];
  // In the time unit of the document.
  time: number;
  // Of the canvas, in CSS pixels; it has `ratio` of its own pixels for each.
  width: number;
  height: number;
  ratio: number;
  dark: boolean;
  colors: { text: string; dim: string; grid: string; ground: string; curves: string[] };
};

// An axis of the values. A periodic axis has no sample at `upper`.
export type PackagedAxis = {
  name: string;
  unit: string;
  lower: number;
  upper: number;
  periodic: boolean;
  samples: number;
  // Positions of the samples.
  points: Float64Array;
};

export type PlotModule = {
  draw: (canvas: HTMLCanvasElement, frame: PackagedFrame) => unknown;
  dispose?: (canvas: HTMLCanvasElement) => unknown;
};

const CURVES = 6;

// Import the module of a plot; an error states what it lacks.
export async function load(
  plot: PlotView,
  bring: (address: string) => Promise<unknown> = (address) =>
    import(/* @vite-ignore */ new URL(address, document.baseURI).href),
): Promise<PlotModule> {
  const found = (await bring(plot.module)) as Partial<PlotModule>;
  if (typeof found.draw !== "function") {
    throw new TypeError("its module exports no function draw(canvas, frame)");
  }
  if (found.dispose !== undefined && typeof found.dispose !== "function") {
    throw new TypeError("dispose, which its module exports, is not a function");
  }
  return found as PlotModule;
}

// Call a function of a module and return whether it raised no exception. `tell` receives an exception as a
// problem that names the package, later if the function is asynchronous.
export function attempt(
  plot: PlotView,
  call: () => unknown,
  tell: (problem: ListedProblem) => void,
): boolean {
  const wrong = (error: unknown) => {
    console.error(error);
    tell(problemOf(plot, error));
  };
  try {
    const result = call();
    if (result instanceof Promise) {
      result.catch(wrong);
    }
    return true;
  } catch (error) {
    wrong(error);
    return false;
  }
}

export function problemOf(plot: PlotView, error: unknown): ListedProblem {
  const what = error instanceof Error ? `${error.name}: ${error.message}` : String(error);
  return {
    what: `The plot "${plot.title}" of the package ${plot.package} failed: ${what}`,
    fix: 'Choose another plot under "Show as", or correct the package and load this page again.',
  };
}

// The axes of the values, which may be thinned.
export function axesOf(form: Announced): PackagedAxis[] {
  return form.axes.map((axis, d) => {
    const { name, unit, lower, upper, periodic } = axis;
    const samples = form.shape[d] ?? axis.samples;
    return { name, unit, lower, upper, periodic, samples, points: points(axis, samples) };
  });
}

export function packagedFrame(
  form: Announced,
  frame: Frame,
  look: Ink,
  size: { width: number; height: number; ratio: number },
): PackagedFrame {
  const { text, dim, grid, ground, shade } = look;
  return {
    // Other plots of the same port read the same frame.
    values: frame.values.slice(),
    shape: [...form.shape],
    axes: axesOf(form),
    folded: [...form.folded],
    time: frame.time,
    ...size,
    dark: shade === "dark",
    colors: {
      text,
      dim,
      grid,
      ground,
      curves: Array.from({ length: CURVES }, (_, n) => curveColor(n, shade)),
    },
  };
}
