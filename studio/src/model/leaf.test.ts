import { describe, expect, test } from "vitest";

import type { AxisView, DocumentView, ElementView, Kind, ParameterForm } from "../protocol";
import { axesOf, driver, formAt, leavesOf, linkable, type Kinds } from "./leaf";

const form = (
  name: string,
  of: ParameterForm["form"] = "number",
  cost: ParameterForm["cost"] = "live",
): ParameterForm => ({
  name,
  form: of,
  cost,
  meaning: "",
  description: "",
  symbol: "",
  unit: "",
  lower: null,
  upper: null,
  default: 0,
  optional: false,
  choices: [],
  of: [],
});

const kind = (name: string, parameters: ParameterForm[]): [string, Kind] => [
  name,
  {
    name,
    room: "elements",
    title: name,
    equation: [],
    reference: "",
    parameters,
    ports: {},
    levels: {},
    maps: {},
    example: null,
    opens: [],
    names: [],
    settings: [],
  },
];

const kinds: Kinds = new Map([
  kind("Sheet", [
    form("axes", "axes", "recompile"),
    form("tau"),
    form("output", "part", "recompile"),
    form("lobes", "parts", "recompile"),
    form("extent", "per_axis", "rebuild"),
    form("extra", "numbers"),
    form("count", "integer", "recompile"),
  ]),
  kind("Curve", [form("slope")]),
  kind("Lobe", [form("width", "per_axis", "rebuild"), form("inner", "part", "recompile")]),
  kind("Follower", [form("shift", "per_axis")]),
]);

const values = {
  axes: ["x"],
  tau: 20,
  output: { kind: "Curve", slope: 4 },
  lobes: [{ kind: "Lobe", width: [1, 2], inner: { kind: "Curve", slope: 2 } }],
  extent: 0,
  extra: { rate: 3 },
  count: 2,
};

describe("the form of a parameter path", () => {
  test.each([
    ["tau", "tau"],
    ["output", "output"],
    ["output.slope", "slope"],
    ["lobes.0.inner.slope", "slope"],
    ["lobes.0.width.1", "width"],
    ["extra.rate", "extra"],
  ])("%s", (path, name) => expect(formAt(kinds, "Sheet", values, path)?.name).toBe(name));

  test.each([
    "",
    "nothing",
    "tau.0",
    "lobes.1.width",
    "lobes.0.width.2",
    "extra.speed",
    "extent.0",
    "output.nothing",
  ])("%s has no form", (path) => expect(formAt(kinds, "Sheet", values, path)).toBe(undefined));

  test("parameters of an unknown kind have no form", () =>
    expect(formAt(kinds, "Stranger", values, "tau")).toBe(undefined));
});

test("the numbers that a document parameter can drive are listed", () => {
  const paths = leavesOf(kinds, "Sheet", values).map((leaf) => leaf.path);
  expect(paths).toEqual([
    "tau",
    "output.slope",
    "lobes.0.width.0",
    "lobes.0.width.1",
    "lobes.0.inner.slope",
    "extent",
    "extra.rate",
  ]);
});

test("whole numbers and numbers that recompile cannot be driven", () => {
  expect(linkable(form("n", "integer"))).toBe(false);
  expect(linkable(form("n", "per_axis", "recompile"))).toBe(false);
  expect(linkable(form("n", "per_axis", "rebuild"))).toBe(true);
});

test("the document parameter that drives a number is found", () => {
  const parameters = [{ name: "tempo", value: 3, links: [{ element: "1", parameter: "tau" }] }];
  const document = { parameters } as unknown as DocumentView;
  expect(driver(document, "1", "tau")?.name).toBe("tempo");
  expect(driver(document, "2", "tau")).toBe(undefined);
  expect(driver(null, "1", "tau")).toBe(undefined);
});

test("an element has axes of its own, or those of its ports", () => {
  const axes = ["x", "y"].map((key): AxisView => ({
    key,
    name: key,
    lower: 0,
    upper: 1,
    samples: 2,
    periodic: false,
    unit: "",
  }));
  const element = (name: string) =>
    ({
      kind: name,
      values: { axes: ["y"] },
      axes: { input: [], output: ["x", "y"] },
    }) as unknown as ElementView;
  const read = (name: string) => axesOf(element(name), kinds.get(name), axes);
  expect(read("Sheet")).toEqual({ axes: [axes[1]], own: true });
  expect(read("Follower")).toEqual({ axes, own: false });
});
