/** The documents of the benchmark. */
import { createHash } from "node:crypto";

const NODE = { kind: "Field", axes: [], tau: 20, resting_level: -2, noise: 0.5 };
const CURVE = {
  kind: "Field",
  axes: ["x"],
  tau: 20,
  resting_level: -5,
  sigmoid: { kind: "Logistic", beta: 4, threshold: 0 },
  kernel: [{ kind: "Gaussian", amplitude: 12, sigma: 5, normalized: true }],
  global_inhibition: 0.6,
  noise: 1,
};
const MAP = {
  ...CURVE,
  axes: ["wide", "high"],
  tau: 50,
  kernel: [{ kind: "Gaussian", amplitude: 12, sigma: 8, normalized: true }],
  global_inhibition: 0.0005,
  noise: 2,
};
const AXES = {
  x: { name: "x", lower: 0, upper: 100, samples: 101, unit: "deg" },
  wide: { name: "wide", lower: 0, upper: 199, samples: 200 },
  high: { name: "high", lower: 0, upper: 199, samples: 200 },
};
const GENERAL = { deodar: 1, time_unit: "ms", axes: AXES, parameters: {}, groups: [] };
const wire = (source: string, target: string) => ({ source: `${source}.output`, target: `${target}.input` });
const spot = (...center: number[]) => ({
  kind: "GaussianStimulus",
  axes: center.length > 1 ? ["wide", "high"] : ["x"],
  center: center.length > 1 ? center : center[0],
  sigma: center.length > 1 ? 15 : 5,
  amplitude: 6,
});

/** Selection, as in the examples: two stimuli and one field of 101 samples. */
export const selection = {
  ...GENERAL,
  name: "selection",
  elements: { u: { ...CURVE, id: ident("u") }, left: spot(30), right: spot(70) },
  connections: [wire("left", "u"), wire("right", "u")],
};

/** The same with `count` plots of the field. */
export function curves(count: number): object {
  const plots = Array.from({ length: count }, () => plot("u", "curve", "activation"));
  return {
    ...selection,
    layout: {
      view: "run",
      panels: panels([plots.slice(0, Math.ceil(count / 2)), plots.slice(Math.ceil(count / 2))]),
    },
  };
}

/** A field of 200 x 200 samples, three over one axis and two nodes, all with noise and stimuli. */
const mixed = {
  ...GENERAL,
  dt: 5,
  elements: {
    map: { ...MAP, id: ident("map") },
    "spot 1": spot(60, 60),
    "spot 2": spot(140, 120),
    u: { ...CURVE, id: ident("u") },
    v: { ...CURVE, id: ident("v") },
    r: { ...CURVE, id: ident("r"), global_inhibition: 0.3 },
    left: spot(30),
    right: spot(70),
    n: { ...NODE, id: ident("n") },
    m: { ...NODE, id: ident("m"), noise: 1 },
  },
  connections: [
    wire("spot 1", "map"),
    wire("spot 2", "map"),
    ...["u", "v", "r"].flatMap((field) => [wire("left", field), wire("right", field)]),
    wire("n", "m"),
  ],
};

const MAPS = [
  plot("map", "heat", "activation"),
  plot("map", "heat", "output"),
  plot("map", "course", "activation"),
];
const CURVES = ["u", "v", "r"].map((field) => plot(field, "curve", "activation"));
const COURSES = ["n", "m", "r"].map((element) => plot(element, "course", "activation"));

/** Nine plots that fill the page, as nine tiles. */
export const nine = {
  ...mixed,
  name: "nine plots",
  layout: { view: "run", panels: panels([MAPS, CURVES, COURSES]) },
};

/** Ten plots that fill the page. */
export const ten = {
  ...mixed,
  name: "ten plots",
  layout: {
    view: "run",
    panels: panels([MAPS, [...CURVES, plot("u", "course", "activation")], COURSES]),
  },
};

/** Two hundred elements in five chains of fields over one axis, without stored positions. */
export function many(count: number): object {
  const names = Array.from({ length: count }, (_, i) => `u${i}`);
  return {
    ...GENERAL,
    name: "many",
    dt: 5,
    elements: Object.fromEntries(names.map((name) => [name, { ...CURVE, id: ident(name) }])),
    connections: names.flatMap((name, i) => (i % 40 === 0 ? [] : [wire(names[i - 1] ?? "", name)])),
    layout: {
      boxes: Object.fromEntries(
        names.map((name, i) => [ident(name), { x: 220 * (i % 20), y: 150 * Math.floor(i / 20) }]),
      ),
      panels: panels([["graph"]]),
    },
  };
}

/** The id of an element by its name. */
export function ident(name: string): string {
  return createHash("sha256").update(name).digest("hex").slice(0, 8);
}

type Plot = { element: string; kind: string; port: string; settings: object };

export function plot(element: string, kind: string, port: string): Plot {
  return { element: ident(element), kind, port, settings: {} };
}

/** Rows of panels that fill the page. */
export function panels(rows: (Plot | "graph")[][]): object {
  const all: Record<string, object> = {};
  const [width, height] = [1280, 740];
  const leaf = (panel: Plot | "graph", share: number) => {
    const id = panel === "graph" ? "graph" : `plot-${Object.keys(all).length + 1}`;
    all[id] =
      panel === "graph"
        ? { id, contentComponent: "graph", title: "Architecture" }
        : { id, contentComponent: "plot", title: panel.element, params: panel };
    return { type: "leaf", size: share, data: { id: `group-${id}`, views: [id], activeView: id } };
  };
  const data = rows.map((row) => ({
    type: "branch",
    size: height / rows.length,
    data: row.map((panel) => leaf(panel, width / row.length)),
  }));
  return {
    grid: { width, height, orientation: "VERTICAL", root: { type: "branch", size: width, data } },
    panels: all,
    activeGroup: "group-plot-1",
  };
}
