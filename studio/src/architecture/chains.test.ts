import { expect, test } from "vitest";
import type { ElementView } from "../protocol";
import { chains } from "./chains";
import { fakeConnections, fakeDocument, fakeElement, fakeForm, fakeKind, kindsOf } from "./fakes";

const KINDS = kindsOf(
  fakeKind("Field", "elements"),
  fakeKind("Gain", "couplings"),
  fakeKind("Mine", "own"),
  fakeKind("Sheet", "own", { parameters: [fakeForm("axes", "axes")] }),
  fakeKind("Unit", "own", { levels: { output: { threshold: "threshold" } } }),
);

const gain = (id: string, kind = "Gain") => fakeElement(id, kind);
const of = (ids: string[], ...paths: string[]) =>
  chains(
    fakeDocument(
      [fakeElement("u"), fakeElement("v"), ...ids.map((id) => gain(id))],
      fakeConnections(...paths),
    ),
    KINDS,
  );

test("a connection without couplings is an edge", () => {
  const { edges, couplings } = of([], "u v");
  expect(edges).toMatchObject([{ source: "u", target: "v", couplings: [] }]);
  expect(couplings.size).toBe(0);
});

test("couplings in a chain are drawn on one edge, in their order", () => {
  const { edges, couplings } = of(["b", "a"], "u a b v");
  expect(edges).toMatchObject([
    { source: "u", source_port: "output", target: "v", target_port: "input", couplings: ["a", "b"] },
  ]);
  expect([...couplings].sort()).toEqual(["a", "b"]);
});

test("a Gain without a name of its own is the strength of its edge, whose id stays", () => {
  const named = (name: string) => fakeElement("g", "Gain", { name });
  const edgesOf = (one: ElementView, ...paths: string[]) =>
    chains(
      fakeDocument([fakeElement("u"), fakeElement("v"), one, gain("k")], fakeConnections(...paths)),
      KINDS,
    ).edges;
  const [plain] = of([], "u v").edges;
  expect(edgesOf(named("u>Gain2"), "u g v")).toMatchObject([{ id: plain?.id, gain: "g", couplings: ["g"] }]);
  expect(edgesOf(named("boost"), "u g v")).toMatchObject([{ gain: null }]);
  const [coupled] = of(["k"], "u k v").edges;
  for (const path of ["u g k v", "u k g v"]) {
    expect(edgesOf(named("u>Gain"), path)).toMatchObject([{ id: coupled?.id, gain: "g" }]);
  }
  const beside = edgesOf(named("u>Gain"), "u v", "u g v");
  expect(beside.map((edge) => edge.gain)).toEqual([null, "g"]);
  expect(new Set(beside.map(({ id }) => id)).size).toBe(2);
});

test("a coupling from a node to itself is drawn on a loop", () => {
  expect(of(["a"], "u a u").edges).toMatchObject([{ source: "u", target: "u", couplings: ["a"] }]);
});

test("a coupling with more than one input or output is a node", () => {
  expect(of(["a"], "u a v", "u a").couplings.size).toBe(0);
  expect(of(["a"], "u a v", "a u").couplings.size).toBe(0);
  expect(of(["a"], "u a").couplings.size).toBe(0);
  expect(of(["a"], "a v").couplings.size).toBe(0);
});

test("a chain continues from a coupling that is a node", () => {
  const { edges } = of(["a", "b"], "u a", "v a", "a b v");
  expect(edges.map((e) => [e.source, e.target, e.couplings])).toEqual([
    ["u", "a", []],
    ["v", "a", []],
    ["a", "v", ["b"]],
  ]);
});

test("the sign of an edge is the product of what its couplings and its source weight", () => {
  const minus = { effect: "-" as const };
  const [positive, negative, both] = [
    gain("a"),
    fakeElement("b", "Gain", minus),
    fakeElement("c", "Gain", { effect: "±" }),
  ];
  const signs = (element: ElementView[], ...paths: string[]) =>
    chains(fakeDocument([fakeElement("u"), fakeElement("v"), ...element], fakeConnections(...paths)), KINDS)
      .edges.map(({ sign }) => sign)
      .join("");
  expect(signs([], "u v")).toBe("+");
  expect(signs([positive, negative], "u a b v")).toBe("-");
  expect(signs([negative, fakeElement("d", "Gain", minus)], "u b d v")).toBe("+");
  expect(signs([both, negative], "u c b v")).toBe("±");
  expect(signs([fakeElement("s", "Field", minus)], "s v"), "a negative stimulus").toBe("-");
  expect(signs([fakeElement("s", "Field", minus), negative], "s b", "u b v"), "into a coupling").toBe("++-");
});

test("a coupling with two input ports is a node", () => {
  const two = fakeElement("a", "Gain", { inputs: ["input", "other"] });
  const found = chains(
    fakeDocument([fakeElement("u"), two, fakeElement("v")], fakeConnections("u a v")),
    KINDS,
  );
  expect(found.couplings.size).toBe(0);
});

test("the couplings of a cycle without other elements are nodes", () => {
  const { edges, couplings } = of(["a", "b"], "a b a");
  expect(couplings.size).toBe(0);
  expect(edges).toHaveLength(2);
});

test("kinds of packages are couplings if they have no state to show", () => {
  const drawn = (kind: string) =>
    chains(
      fakeDocument([fakeElement("u"), gain("a", kind), fakeElement("v")], fakeConnections("u a v")),
      KINDS,
    ).couplings.size;
  expect(["Mine", "Sheet", "Unit", "unheard of"].map(drawn)).toEqual([1, 0, 0, 0]);
});

test("a chain is delayed if any of its connections is", () => {
  const connections = fakeConnections("u a v").map((c, i) => ({
    ...c,
    reads: i === 1 ? "delayed" : "current",
  }));
  const found = chains(fakeDocument([fakeElement("u"), gain("a"), fakeElement("v")], connections), KINDS);
  expect(found.edges[0]?.reads).toBe("delayed");
});

test("two chains between the same ports differ", () => {
  const { edges } = of(["a", "b"], "u a v", "u b v", "u v");
  expect(new Set(edges.map((e) => e.id)).size).toBe(3);
});
