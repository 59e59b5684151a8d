// Documents and kinds for tests.

import { readFileSync } from "node:fs";
import { join } from "node:path";

import type { ConnectionView, DocumentView, ElementView, Kind, LayoutView, ParameterForm } from "../protocol";

export function fakeElement(path: string, kind = "Field", more: Partial<ElementView> = {}): ElementView {
  const parts = path.split(".");
  return {
    id: path,
    path,
    name: parts[parts.length - 1] ?? "",
    group: parts.slice(0, -1),
    kind,
    every: 1,
    values: {},
    inputs: ["input"],
    outputs: ["output"],
    axes: {},
    pushable: false,
    kernel: false,
    effect: "+",
    strength: "",
    ...more,
  };
}

// "a b c": a to b, and b to c.
export function fakeConnections(...paths: string[]): ConnectionView[] {
  return paths.flatMap((path) => {
    const on = path.split(" ");
    return on.slice(1).map((target, i) => ({
      source: on[i] as string,
      source_port: "output",
      target,
      target_port: "input",
      reads: "",
    }));
  });
}

export function fakeLayout(more: Partial<LayoutView> = {}): LayoutView {
  const lists = { pins: [], presets: [], plots: [], tiles: null, folded: null };
  return { boxes: {}, comments: {}, view: null, every_element: false, ...lists, ...more };
}

export function fakeDocument(
  elements: ElementView[],
  connections: ConnectionView[] = [],
  { layout = {}, ...more }: Partial<Omit<DocumentView, "layout">> & { layout?: Partial<LayoutView> } = {},
): DocumentView {
  const rest = {
    notes: "",
    axes: [],
    groups: [],
    parameters: [],
    layout: fakeLayout(layout),
    problems: [],
    unsaved: false,
    undo: 0,
    redo: 0,
  };
  return { file: "", title: "test", time_unit: "ms", dt: 1, ...rest, elements, connections, ...more };
}

type CosivinaPart = { label: string; class: string; input: { label: string }[] | { label: string } | null };

// A file of cosivina of the importer's tests: its elements as boxes, stimuli and couplings.
export function fakeCosivina(file: string): DocumentView {
  const path = join(import.meta.dirname, "../../../tests/deodar_interop/importers/cosivina", file);
  const { simulator } = JSON.parse(readFileSync(path, "utf8")) as { simulator: { elements: CosivinaPart[] } };
  const boxes = /NeuralField|SingleNode|MemoryTrace|DynamicVariable|RunningHistory/;
  const elements = simulator.elements.map(({ label, class: name }) =>
    /Stimulus|Noise/.test(name)
      ? fakeElement(label, /Gauss/.test(name) ? "GaussianStimulus" : "Noise", { inputs: [] })
      : fakeElement(label, boxes.test(name) ? "Field" : "Gain"),
  );
  const links = simulator.elements.flatMap(({ label, input }) =>
    [input ?? []].flat().map(({ label: source }) => ({
      source,
      source_port: "output",
      target: label,
      target_port: "input",
      reads: "",
    })),
  );
  return fakeDocument(elements, links);
}

type StoredModel = {
  elements: Record<string, { kind: string }>;
  connections: { source: string; target: string }[];
  groups: string[];
};

const WEIGHTS = /^(Gain|Project|Convolve|Shift|Weighting|Weights|AdaptiveWeights|Pointwise|Resample)$/;

// An example of the gallery: its elements with the ports that are connected, without their values.
export function fakeExample(name: string): DocumentView {
  const path = join(import.meta.dirname, "../../../examples", `${name}.json`);
  const { elements, connections, groups } = JSON.parse(readFileSync(path, "utf8")) as StoredModel;
  const parted = (end: string) => ({
    id: end.slice(0, end.lastIndexOf(".")),
    port: end.slice(end.lastIndexOf(".") + 1),
  });
  const links = connections.map(({ source, target }) => ({ from: parted(source), to: parted(target) }));
  const portsOf = (id: string, side: "from" | "to") => [
    ...new Set(links.flatMap((link) => (link[side].id === id ? [link[side].port] : []))),
  ];
  return fakeDocument(
    Object.entries(elements).map(([id, { kind }]) =>
      fakeElement(id, WEIGHTS.test(kind) ? "Gain" : "Field", {
        inputs: portsOf(id, "to"),
        outputs: portsOf(id, "from"),
        axes: { output: ["x"] },
      }),
    ),
    links.map(({ from, to }) => ({
      source: from.id,
      source_port: from.port,
      target: to.id,
      target_port: to.port,
      reads: "",
    })),
    { groups: groups.map((group) => group.split(".")) },
  );
}

export function fakeKind(name: string, room: string, more: Partial<Kind> = {}): Kind {
  return {
    name,
    room,
    title: name,
    equation: [],
    reference: "",
    parameters: [],
    ports: {},
    levels: {},
    maps: {},
    example: null,
    opens: [],
    names: [],
    settings: [],
    ...more,
  };
}

export function fakeForm(
  name: string,
  form: ParameterForm["form"],
  more: Partial<ParameterForm> = {},
): ParameterForm {
  const rest = {
    cost: "live" as const,
    meaning: name,
    description: "",
    symbol: "",
    unit: "",
    lower: null,
    upper: null,
  };
  return { name, form, ...rest, default: null, optional: false, choices: [], of: [], ...more };
}

export function kindsOf(...kinds: Kind[]): Map<string, Kind> {
  return new Map(kinds.map((kind) => [kind.name, kind]));
}
