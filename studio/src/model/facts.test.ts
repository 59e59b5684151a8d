import { expect, test } from "vitest";
import { facts, mainNumber, short } from "./facts";
import { fakeDocument, fakeElement, fakeForm, fakeKind, kindsOf } from "../architecture/fakes";

const KIND = fakeKind("Field", "elements", {
  parameters: [
    fakeForm("kernel", "parts"),
    fakeForm("tau", "number", { unit: "time", symbol: "\\tau" }),
    fakeForm("center", "per_axis", { unit: "axis" }),
    fakeForm("reduce", "text", { choices: ["sum", "max"] }),
    fakeForm("file", "text"),
  ],
});
const KINDS = kindsOf(KIND, fakeKind("Gaussian", "kernels", { title: "Gaussian kernel" }));
const ELEMENT = fakeElement("u", "Field", {
  values: {
    tau: 20,
    center: [1, -2.5],
    reduce: "max",
    file: "a.png",
    kernel: [{ kind: "Gaussian" }, { kind: "Own" }],
  },
  axes: { output: ["x"] },
});
const AXES = [{ key: "x", name: "x", lower: 0, upper: 1, samples: 5, periodic: false, unit: "deg" }];

test("an element shows its main values with units, numbers first", () => {
  const said = facts(ELEMENT, KIND, KINDS, fakeDocument([ELEMENT], [], { axes: AXES }));
  expect(said.map((fact) => fact.value)).toEqual(["20 ms", "1, −2.5 deg", "max", "Gaussian kernel, Own"]);
});

test("a stimulus that is always or never on says so", () => {
  const kind = fakeKind("Boost", "elements", {
    parameters: [fakeForm("windows", "parts", { optional: true, if_none: "always", if_empty: "never" })],
  });
  const said = (windows: unknown) =>
    facts(fakeElement("s", "Boost", { values: { windows } }), kind, KINDS, fakeDocument([]));
  expect([null, []].map((windows) => said(windows).map((fact) => fact.value))).toEqual([
    ["always"],
    ["never"],
  ]);
});

test("a number that a document parameter drives shows its value", () => {
  const document = fakeDocument([ELEMENT], [], {
    axes: AXES,
    parameters: [{ name: "tempo", value: 35, links: [{ element: "u", parameter: "tau" }] }],
  });
  expect(mainNumber(ELEMENT, KIND, document)).toBe("35 ms");
});

test("a coupling without numbers has no main number", () => {
  expect(mainNumber(ELEMENT, fakeKind("Sum", "couplings"), fakeDocument([]))).toBe("");
  expect(mainNumber(ELEMENT, undefined, fakeDocument([]))).toBe("");
});

test("numbers are shortened to three digits", () => {
  expect([0, 1, -2.5, 0.1 + 0.2, 1234567, 0.00012].map(short)).toEqual([
    "0",
    "1",
    "−2.5",
    "0.3",
    "1.23e+6",
    "1.20e−4",
  ]);
});
