// A kind of plot as data: what it asks the server for, and the content that it makes of it.

import type { Content } from "../../draw/content";
import type { Paint } from "../../draw/ink";
import type { AxisView, DocumentView, ElementView, Kind } from "../../protocol";
import type { Live, Wish } from "../../server/streams";
import type { Memory } from "./memory";
import type { PlotSettings } from "../../model/settings";

// What an element has to plot besides its port: an interaction kernel, weights that do not learn, and other
// elements that have the port over the same axes.
export type Further = { kernel?: boolean; weights?: boolean; several?: boolean };

// What a plot is of, at present.
export type Shown = Readonly<{
  document: DocumentView;
  elements: ReadonlyMap<string, ElementView>;
  type: Kind | undefined;
  element: ElementView;
  port: string;
  settings: PlotSettings;
  // The moment of the past that the page shows.
  moment: number | null;
}>;

// `press` and `remove` are the settings after a press on the entry, and on its cross.
export type LegendEntry = Readonly<{
  label: string;
  color: Paint;
  dashed?: boolean;
  on: boolean;
  press?: Partial<PlotSettings>;
  remove?: Partial<PlotSettings>;
}>;

// The groups of controls that a kind has.
export type ControlName = "drawn" | "window" | "range" | "scale" | "down" | "push" | "traces" | "trajectory";

type Declared = {
  // In the menu of plots.
  title: string;
  // Its place among the plots of an array over these axes, the smallest first; null if it cannot show it.
  rank: (axes: AxisView[], further: Further) => number | null;
  // The most axes of an array in the figure that `deodar plot` draws of it; without it there is none.
  figure?: number;
};

// What draws a plot with three.js: the export of this name of `scenes/NAME.tsx`.
export type SceneDeclaration = Declared & { component: string };

type Flat = Declared & {
  settings: (shown: Shown) => readonly ControlName[];
  // What the axes are called that can be exchanged for others.
  sides?: readonly string[];
  // Which ports of the element can be chosen.
  ports?: (axes: AxisView[]) => boolean;
  // What it shows, in words, and the title of its files.
  label: (shown: Shown) => string;
  file: (shown: Shown) => string;
  note?: (shown: Shown) => string;
  legend?: (shown: Shown) => LegendEntry[];
  wishes: (shown: Shown) => Wish[];
};

export type SinglePlot = Flat & {
  // Null: nothing is known yet.
  content: (shown: Shown, lives: readonly Live[], memory: Memory) => Content | null;
};

// Several drawings side by side, one for each element.
export type MultiplePlot = Flat & {
  cells: (shown: Shown) => readonly ElementView[];
  contents: (shown: Shown, lives: readonly Live[], memory: Memory) => (Content | null)[];
};

export type FlatPlot = SinglePlot | MultiplePlot;
export type PlotDeclaration = SceneDeclaration | FlatPlot;
