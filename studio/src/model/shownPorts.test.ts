import { expect, it } from "vitest";
import type { DocumentView, ElementView, Kind } from "../protocol";
import { type PlotSettings, readSettings } from "./settings";
import { shownPorts } from "./shownPorts";

const field = (id: string) =>
  ({
    id,
    outputs: ["activation", "output"],
    inputs: ["input"],
    axes: { activation: ["x"], output: ["x"], input: ["x"] },
  }) as unknown as ElementView;
const [u, v] = [field("u"), field("v")];
const document = { elements: [u, v] } as unknown as DocumentView;
const type = { levels: { activation: { threshold: "sigmoid.threshold" } } } as unknown as Kind;

function shown(kind: string, settings: Partial<PlotSettings> = {}): string[] {
  const all = { ...readSettings({}), ...settings };
  const plot = { kind, port: "activation" };
  return shownPorts(document, u, type, plot, all).map(({ element, port }) => `${element} ${port}`);
}

it("curves show activation and output at first, and what is chosen then", () => {
  expect(shown("curve")).toEqual(["u activation", "u output"]);
  expect(shown("curve", { shown: ["input", "levels"] })).toEqual(["u input"]);
});

it("time courses and phase plots show ports of several elements", () => {
  const trace = { element: "v", port: "output", reduce: "max", at: [] } as const;
  expect(shown("course")).toEqual(["u activation"]);
  expect(shown("course", { traces: [{ ...trace, at: [] }] })).toEqual(["v output"]);
  expect(shown("phase", { up: { ...trace, at: [] } })).toEqual(["u activation", "v output"]);
});

it("small multiples show one port of all elements alike, kernel and weights none", () => {
  expect(shown("multiples")).toEqual(["u activation", "v activation"]);
  expect(shown("heat")).toEqual(["u activation"]);
  expect(shown("kernel")).toEqual([]);
  expect(shown("weights")).toEqual([]);
});
