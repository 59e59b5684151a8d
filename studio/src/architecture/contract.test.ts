import { expect, test } from "vitest";
import { openSearch } from "../commands/commands";
import { useChooser } from "../state/choice";
import { search } from "../model/entries";
import { useStudio } from "../server/store";
import { contract, contractAll, contractionIn } from "./contract";
import {
  fakeConnections,
  fakeCosivina,
  fakeDocument,
  fakeElement,
  fakeKind,
  fakeLayout,
  kindsOf,
} from "./fakes";
import type { ElementView } from "../protocol";

const KINDS = kindsOf(
  fakeKind("Field", "elements"),
  fakeKind("GaussianStimulus", "elements"),
  fakeKind("Noise", "elements"),
  fakeKind("Gain", "couplings"),
);
const NONE = new Set<string>();
const part = (id: string, more: Partial<ElementView> = {}) => fakeElement(id, "Gain", more);
const source = (id: string) => fakeElement(id, "Noise", { inputs: [] });
const of = (elements: ElementView[], ...paths: string[]) =>
  contractAll(
    fakeDocument([fakeElement("u"), fakeElement("v"), ...elements], fakeConnections(...paths)),
    KINDS,
    NONE,
  );

test("the 168 elements of the scene representation are 20 boxes, 86 wires, dots and badges", () => {
  const document = fakeCosivina("presetSceneRepresentation.json");
  const contraction = contract(document, KINDS);
  expect(document.elements).toHaveLength(168);
  expect(contraction?.boxes).toHaveLength(20);
  expect(contraction?.edges).toHaveLength(86);
  const drawn = new Set([
    ...(contraction?.boxes ?? []),
    ...(contraction?.edges.flatMap(({ couplings }) => couplings) ?? []),
    ...[...(contraction?.dots.values() ?? [])].flat(),
    ...[...(contraction?.badges.values() ?? [])].flat(),
  ]);
  expect(document.elements.filter(({ id }) => !drawn.has(id))).toEqual([]);
});

test("a search for its name finds each of the 168 elements first", () => {
  const document = fakeCosivina("presetSceneRepresentation.json");
  useStudio.setState({ document, kinds: KINDS });
  openSearch();
  const { entries = [] } = useChooser.getState().choice ?? {};
  expect(entries).toHaveLength(168);
  const best = (text: string) => search(text, entries).best?.id;
  const missed = document.elements.filter(({ id, path }) => best(path) !== `element ${id}`);
  expect(missed.map(({ path }) => path)).toEqual([]);
});

test("small documents, those with groups, and those that show every element are not contracted", () => {
  const large = fakeCosivina("presetSceneRepresentation.json");
  expect(contract(fakeCosivina("presetThreeLayerField_spRecall_adult.json"), KINDS)).toBeNull();
  expect(contract({ ...large, groups: [["g"]] }, KINDS)).toBeNull();
  const shown = { ...large, layout: fakeLayout({ every_element: true }) };
  expect(contract(shown, KINDS)).toBeNull();
  expect(contractionIn(shown, KINDS)).not.toBeNull();
  expect(contract(large, KINDS)).not.toBeNull();
});

test("couplings between two boxes are on one wire, whatever way they lead", () => {
  const { edges, couplings } = of(
    ["a", "b", "c"].map((id) => part(id)),
    "u a b v",
    "u c v",
  );
  expect(edges).toMatchObject([
    { source: "u", source_port: "output", target: "v", target_port: "input", couplings: ["a", "c", "b"] },
  ]);
  expect([...couplings]).toEqual(["a", "b", "c"]);
});

test("a coupling of several wires is on each of them", () => {
  const { edges } = contractAll(
    fakeDocument(
      [...["u", "v", "w"].map((id) => fakeElement(id)), part("sum"), part("a"), part("b")],
      fakeConnections("u sum a v", "sum b w"),
    ),
    KINDS,
    NONE,
  );
  expect(edges.map((one) => [one.target, one.couplings])).toEqual([
    ["v", ["sum", "a"]],
    ["w", ["sum", "b"]],
  ]);
  // removing one wire leaves what the other one needs
  expect(edges.map(({ content }) => content.elements)).toEqual([["a"], ["b"]]);
  expect(edges.map(({ isChain }) => isChain)).toEqual([false, false]);
});

test("a wire without couplings of its own has the connections of its own", () => {
  const { edges } = of([part("product")], "u product v", "v product");
  const [first, ...others] = edges;
  expect(others).toEqual([]);
  expect(first?.content.elements).toEqual([]);
  expect(first?.content.connections).toMatchObject([{ source: "u", target: "product" }]);
});

test("stimuli and what weights them are dots in every box that they feed", () => {
  const { dots, edges } = of([source("s"), source("t"), part("a")], "s a u", "t u", "t v");
  expect([...dots]).toEqual([
    ["u", ["s", "t", "a"]],
    ["v", ["t"]],
  ]);
  expect(edges).toEqual([]);
});

test("a coupling of a box to itself is a badge, and what feeds nothing is a dot of what it reads", () => {
  const { badges, dots } = of([part("own"), part("end")], "u own u", "v end");
  expect([...badges]).toEqual([["u", ["own"]]]);
  expect([...dots]).toEqual([["v", ["end"]]]);
});

test("what no box reads or feeds is a box", () => {
  expect(of([source("s"), part("r"), part("q")], "r q r").boxes).toEqual(["u", "v", "s", "r"]);
});

test("elements that a person has placed stay boxes", () => {
  const large = fakeCosivina("presetSceneRepresentation.json");
  const placed = contract(
    { ...large, layout: fakeLayout({ boxes: { "boost wm_s": { x: 0, y: 0 } } }) },
    KINDS,
  );
  expect(placed?.boxes).toHaveLength(21);
});

test("a wire has the sign and the delay of all its ways", () => {
  const sign = (...effects: ElementView["effect"][]) =>
    of(
      effects.map((effect, i) => part(`k${i}`, { effect })),
      ...effects.map((_, i) => `u k${i} v`),
    ).edges[0]?.sign;
  expect([sign("+"), sign("-"), sign("+", "-"), sign("-", "-")]).toEqual(["+", "-", "±", "-"]);
  const twice = of([part("a", { effect: "-" }), part("b", { effect: "-" })], "u a b v").edges[0];
  expect(twice?.sign).toBe("+");
  const document = fakeDocument(
    [fakeElement("u"), fakeElement("v"), part("a")],
    fakeConnections("u a v").map((c) => ({ ...c, reads: c.source === "a" ? "previous" : "current" })),
  );
  expect(contractAll(document, KINDS, NONE).edges[0]?.reads).toBe("previous");
});

test("a coupling that joins many elements with many is a box, not a wire for each pair", () => {
  const names = ["a", "b", "c", "d"];
  const fields = names.map((name) => fakeElement(name));
  const paths = names.map((name) => `${name} hub ${name}`);
  const { boxes, edges } = contractAll(
    fakeDocument([...fields, part("hub")], fakeConnections(...paths)),
    KINDS,
    NONE,
  );
  expect(boxes).toContain("hub");
  expect(edges).toHaveLength(2 * names.length);
});
