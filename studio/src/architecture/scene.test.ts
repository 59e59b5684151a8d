import { expect, test } from "vitest";
import { fakeConnections, fakeDocument, fakeElement, fakeKind, kindsOf } from "./fakes";
import { BOX, boxSize } from "./boxes";
import { withCourses } from "./courses";
import type { Point } from "../model/rects";
import type { ElementView } from "../protocol";
import { differ, moved } from "./moved";
import type { BoxNode } from "./nodes";
import { foldedAround, groupNode, PORT, scene } from "./scene";

const KINDS = kindsOf(
  fakeKind("Field", "elements", { title: "Neural field" }),
  fakeKind("Gain", "couplings"),
);
const ELEMENTS = [
  fakeElement("s"),
  fakeElement("g.u"),
  fakeElement("g.v"),
  fakeElement("g.k", "Gain"),
  fakeElement("t"),
];
const WIRES = fakeConnections("s g.u", "s g.v", "g.u g.k g.v", "g.v t");

const made = (folded: string[], boxes = {}) =>
  scene(fakeDocument(ELEMENTS, WIRES, { layout: { folded, boxes } }), KINDS);

test("an open group is a frame before its elements; couplings are on edges", () => {
  const { nodes, pills } = made([]);
  expect(nodes.map((n) => [n.id, n.type])).toEqual([
    ["group:g", "frame"],
    ["g.u", "box"],
    ["g.v", "box"],
    ["s", "box"],
    ["t", "box"],
  ]);
  expect(nodes.find((n) => n.id === "g.u")).toMatchObject({
    parentId: "group:g",
    data: { title: "Neural field" },
  });
  expect([...pills.keys()]).toEqual(["g.k"]);
});

test("edges end at a folded group, parallel edges become one, and the group has the ports of all", () => {
  const { nodes, wires } = made(["g"]);
  expect(nodes.map((n) => n.type)).toEqual(["folded", "box", "box"]);
  expect(wires.map((w) => [w.source, w.target, w.data?.count])).toEqual([
    ["s", "group:g", 2],
    ["group:g", "t", 1],
  ]);
  expect(nodes[0]?.handles?.map(({ id, type }) => [id, type])).toEqual([
    [null, "target"],
    [null, "source"],
    ["g.u input", "target"],
    ["g.v input", "target"],
    ["g.v output", "source"],
  ]);
});

test("a box states its dimensions, as long as they are known", () => {
  const over = (id: string, ...axes: string[]) =>
    fakeElement(id, "Field", { outputs: ["output", "activation"], axes: { activation: axes } });
  const elements = [over("node"), over("field", "x"), over("plane", "x", "y"), fakeElement("unknown")];
  const boxes = scene(fakeDocument(elements), KINDS).nodes;
  expect(boxes.map(({ data }) => "dimensions" in data && data.dimensions)).toEqual([0, 1, 2, null]);
});

test("edges state their sign; a dot lies behind an arrow at the same port", () => {
  const elements = [
    ...["a", "b", "c"].map((id) => fakeElement(id)),
    fakeElement("k", "Gain", { effect: "-" }),
    fakeElement("l", "Gain", { effect: "-" }),
  ];
  const { wires } = scene(fakeDocument(elements, fakeConnections("a b", "c k b", "a l c")), KINDS);
  expect(wires.map(({ ariaLabel, data }) => [ariaLabel, data?.sign, data?.shared])).toEqual([
    ["a to b", "+", true],
    ["c to b, inhibition", "-", true],
    ["a to c, inhibition", "-", false],
  ]);
});

test("the wire of a folded group has the signs of all that it stands for", () => {
  const elements = [...ELEMENTS, fakeElement("l", "Gain", { effect: "-" })];
  const wires = scene(
    fakeDocument(elements, fakeConnections("s g.u", "s l g.v"), { layout: { folded: ["g"] } }),
    KINDS,
  ).wires.map(({ data }) => data?.sign);
  expect(wires).toEqual(["±"]);
});

test("all wires have courses, from port to port; those back run side by side", () => {
  const elements = [fakeElement("a"), fakeElement("b")];
  const wired = scene(fakeDocument(elements, fakeConnections("a b", "b b", "b a", "a a")), KINDS);
  const found = withCourses(wired).map(({ data }) => data?.course);
  expect(found).toHaveLength(4);
  expect(new Set(found.map((course) => course?.path)).size).toBe(4);
  const [{ x, y }, { width, height }] = [
    wired.places.elements.get("a") as Point,
    boxSize(elements[0] as ElementView),
  ];
  expect(found[0]?.from).toEqual({ x: x + width + PORT / 2, y: y + height / 2 });
});

test("the folded groups around an element are found", () => {
  expect(foldedAround(made(["g"]).tree, "g.k")).toEqual(["g"]);
  expect(foldedAround(made([]).tree, "g.k")).toEqual([]);
});

test("unmoved boxes do not differ", () => {
  const { nodes, tree, places } = made([]);
  expect(differ(moved(nodes, tree, places), places)).toBe(false);
});

test("a moved frame moves its elements", () => {
  const { nodes, tree, places } = made([]);
  const shifted = nodes.map((n) =>
    n.id === groupNode("g") ? { ...n, position: { x: n.position.x + 50, y: n.position.y } } : n,
  );
  const boxes = moved(shifted, tree, places);
  expect(boxes.get("g.u")?.x).toBe((places.elements.get("g.u")?.x ?? 0) + 50);
  expect(boxes.get("s")).toEqual(places.elements.get("s"));
  expect(differ(boxes, places)).toBe(true);
});

test("a moved folded group moves its elements, and unfolds at the new position", () => {
  const { nodes, tree, places } = made(["g"]);
  const shifted = nodes.map((n) =>
    n.id === groupNode("g") ? { ...n, position: { x: n.position.x + 300, y: n.position.y - 20 } } : n,
  );
  const boxes = moved(shifted, tree, places);
  expect(boxes.get("g.v")).toEqual({
    x: (places.elements.get("g.v")?.x ?? 0) + 300,
    y: (places.elements.get("g.v")?.y ?? 0) - 20,
  });
  const again = made(["g"], Object.fromEntries(boxes));
  expect(again.places.groups.get("g")?.x).toBe((places.groups.get("g")?.x ?? 0) + 300);
});

test("a box is higher by each pinned slider, and its ports are where its height places them", () => {
  const pins = ["a", "b", "c"].map((parameter) => ({ element: "s", parameter }));
  const box = (layout: object) => {
    const { nodes } = scene(fakeDocument(ELEMENTS, WIRES, { layout: { ...layout } }), KINDS);
    return nodes.find((node): node is BoxNode => node.type === "box" && node.id === "s") as BoxNode;
  };
  const [bare, pinned] = [box({}), box({ pins })];
  expect(pinned.height).toBe((bare.height ?? 0) + 2 * BOX.pin);
  expect(pinned.data.pins).toEqual(pins.slice(0, 2));
  expect(pinned.handles?.[0]?.y).toBe(Math.round((pinned.height ?? 0) / 2) - PORT / 2);
});
