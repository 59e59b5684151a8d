// The nodes and edges of a document, in the form of xyflow. Pure; live values and parameters
// are no part of it.

import { Position, type NodeHandle } from "@xyflow/react";
import { boxPins } from "../state/pin";
import type { CommentView, ElementView, Kind, PinView } from "../protocol";
import { boxSize, dimensions, portHeight } from "./boxes";
import { contract, type Structure } from "./contract";
import type { BoxNode, CommentNode, FoldedNode, FrameNode, GroupData, SceneNode, Wire } from "./nodes";
import { type CellFrame, cellFrames, CHIP, contractedWires, inGrid, linksOf, withParts } from "./contracted";
import { chains, type Chain } from "./chains";
import { COUNT, FOLDED, places, type Places } from "./layout";
import type { Point, Rect, Size } from "../model/rects";
import { signText, together } from "./sign";
import { around, hiddenBy, outside, tree, type Branch, type Tree } from "./tree";

export type GraphScene = {
  nodes: SceneNode[];
  wires: Wire[];
  tree: Tree;
  places: Places;
  // The wires and the boxes that show elements without a box.
  pills: Map<string, string>;
  holders: Map<string, string>;
  // What each box, part and wire of a contracted architecture is joined with; null for others.
  links: Map<string, Set<string>> | null;
  // Around the cells of its grid.
  frames: CellFrame[];
};

// Ids of nodes for groups cannot be those of elements, which are hashes.
export const groupNode = (key: string): string => `group:${key}`;
export const groupKey = (node: string): string => node.slice("group:".length);

// The size of a port, in graph.css too.
export const PORT = 7;

export const PILL = { height: 22, gap: 4, letter: 6.6, pad: 34, most: 132 };

// `panel` is the size of the canvas, whose shape the layout takes.
export function scene(structure: Structure, kinds: Map<string, Kind>, panel?: Size): GraphScene {
  const { elements, groups, layout } = structure;
  const contraction = contract(structure, kinds);
  const chained = contraction ?? chains(structure, kinds);
  const found = tree(elements, groups, layout.folded ?? [], chained.couplings);
  const names = new Map(elements.map((e) => [e.id, e]));
  // The cells of a grid are of one size, which sliders in one of them would change for all.
  const pins = (id: string) => (contraction === null ? boxPins(layout, id) : []);
  const sizes = new Map<string, Size>(elements.map((e) => [e.id, boxSize(e, pins(e.id).length)]));
  // The boxes of a connection without couplings stay apart as they are where it gets a strength.
  const room = (edge: Chain) => {
    const width = widthOf(edge, names);
    return contraction !== null ? CHIP : edge.gain === null || width === 0 ? width : width + STATED;
  };
  const bonds = chained.edges.map((e) => ({ source: e.source, target: e.target, room: room(e) }));
  const stored = new Map(Object.entries(layout.boxes));
  const grid = contraction === null ? [] : inGrid({ contraction, names, kinds, sizes }, stored, panel);
  const boxes = new Map([...grid, ...stored]);
  const where = places(found.root, sizes, bonds, boxes, panel);
  const borders = foldedPorts(chained.edges, found, names);
  const led = wiresOf(chained.edges, found, names);
  const wires = contraction === null ? led : contractedWires(led, contraction);
  const nodes = nodesOf(found.root, names, kinds, sizes, where, borders);
  return {
    nodes: [
      ...nodes.map((node) => (contraction === null ? withPins(node, pins) : withParts(node, contraction))),
      ...Object.entries(layout.comments).map(commentNode),
    ],
    wires,
    tree: found,
    places: where,
    pills: new Map(
      wires.flatMap(({ id, data }) => (data?.revealed ?? []).map((pill) => [pill, id] as const)),
    ),
    holders: new Map(
      [...(contraction?.badges ?? []), ...(contraction?.dots ?? [])].flatMap(([box, parts]) =>
        parts.map((part) => [part, box] as const),
      ),
    ),
    links: contraction === null ? null : linksOf(wires, contraction),
    frames: contraction === null ? [] : cellFrames(boxesIn(nodes)),
  };
}

const boxesIn = (nodes: SceneNode[]) =>
  nodes.flatMap(({ type, data, position, width = 0, height = 0 }) =>
    type === "box" ? [{ name: data.name, rect: { ...position, width, height } }] : [],
  );

// The width of a stated strength on a connection.
export const STATED = 40;

// The width that the pills of these names need on an edge, about.
export function pillsWidth(names: string[]): number {
  return names.reduce(
    (sum, name) => sum + PILL.gap + Math.min(PILL.most, PILL.pad + PILL.letter * name.length),
    0,
  );
}

// The width of the couplings on a connection, without its strength.
function widthOf({ couplings, gain }: Chain, names: Map<string, ElementView>): number {
  return pillsWidth(couplings.flatMap((id) => (id === gain ? [] : (names.get(id)?.name ?? ""))));
}

// Folded groups hide their elements; an open group is a frame and precedes its elements, because xyflow
// requires parents first.
function nodesOf(
  branch: Branch,
  names: Map<string, ElementView>,
  kinds: Map<string, Kind>,
  sizes: Map<string, Size>,
  where: Places,
  borders: Map<string, Border>,
): SceneNode[] {
  const parent = branch.key === "" ? null : (where.groups.get(branch.key) ?? null);
  const stand = (at: Point) => ({
    position: { x: at.x - (parent?.x ?? 0), y: at.y - (parent?.y ?? 0) },
    ...(parent === null ? {} : { parentId: groupNode(branch.key) }),
  });
  const boxes = branch.elements.flatMap((id) => {
    const element = names.get(id);
    const at = where.elements.get(id);
    return element === undefined || at === undefined
      ? []
      : [boxNode(element, kinds, sizes.get(id) ?? FOLDED, stand(at))];
  });
  const groups = branch.groups.flatMap((group) => {
    const rect = where.groups.get(group.key);
    if (rect === undefined) {
      return [];
    }
    const own = groupOf(group, rect, stand(rect), borders.get(group.key) ?? NO_BORDER);
    return group.folded ? [own] : [own, ...nodesOf(group, names, kinds, sizes, where, borders)];
  });
  return [...groups, ...boxes];
}

const withPins = (node: SceneNode, pins: (element: string) => PinView[]): SceneNode =>
  node.type === "box" ? { ...node, data: { ...node.data, pins: pins(node.id) } } : node;

// Ids of comments cannot be those of elements.
export const commentId = (node: string): string => node.slice("comment:".length);

function commentNode([id, { text, x, y, width, height }]: [string, CommentView]): CommentNode {
  return {
    id: `comment:${id}`,
    type: "comment",
    position: { x, y },
    width,
    height,
    measured: { width, height },
    handles: [],
    data: { comment: id, text },
    selectable: false,
    focusable: false,
    ariaLabel: `Comment: ${text}`,
    zIndex: 2,
  };
}

type Stand = { position: Point; parentId?: string };

function boxNode(element: ElementView, kinds: Map<string, Kind>, size: Size, stand: Stand): BoxNode {
  const { id, path, name, inputs, outputs } = element;
  const kind = kinds.get(element.kind);
  const title = kind?.title ?? element.kind;
  return {
    id,
    type: "box",
    ...stand,
    ...size,
    measured: size,
    handles: [...ports(inputs, "target", size), ...ports(outputs, "source", size)],
    data: {
      element: id,
      path,
      name,
      title,
      kind: element.kind,
      dimensions: dimensions(element),
      inputs,
      outputs,
      dots: [],
      badges: [],
      pins: [],
    },
    ariaLabel: `${path}, ${title}`,
    zIndex: 2,
  };
}

function groupOf(group: Branch, rect: Rect, stand: Stand, border: Border): FrameNode | FoldedNode {
  const data = { key: group.key, name: group.name, count: group.count, ...border };
  const common = {
    id: groupNode(group.key),
    ...stand,
    width: rect.width,
    height: rect.height,
    measured: { width: rect.width, height: rect.height },
    data,
    selectable: false,
  };
  if (group.folded) {
    const handles = [
      ...ports([""], "target", FOLDED),
      ...ports([""], "source", FOLDED),
      ...ports(border.inputs.map(portHandle), "target", FOLDED),
      ...ports(border.outputs.map(portHandle), "source", FOLDED),
    ];
    return {
      ...common,
      type: "folded",
      handles,
      ariaLabel: `Group ${group.key}, folded, ${group.count} elements`,
      zIndex: 2,
    };
  }
  return {
    ...common,
    type: "frame",
    handles: [],
    dragHandle: ".graph-frame-title",
    focusable: false,
    ariaLabel: `Group ${group.key}`,
    zIndex: 0,
  };
}

// xyflow receives handles beforehand: edges to invisible nodes are then drawn without mounting those.
function ports(names: string[], type: "source" | "target", { width, height }: Size): NodeHandle[] {
  const left = type === "target";
  return names.map((id, n) => ({
    id: id === "" ? null : id,
    type,
    position: left ? Position.Left : Position.Right,
    x: (left ? 0 : width) - PORT / 2,
    y: portHeight(height, n, names.length) - PORT / 2,
    width: PORT,
    height: PORT,
  }));
}

// The most ports that a side of a folded group shows.
const MOST_PORTS = 5;

type Border = Pick<GroupData, "inputs" | "outputs">;
const NO_BORDER: Border = { inputs: [], outputs: [] };

export const portHandle = ({ element, port }: { element: string; port: string }): string =>
  `${element} ${port}`;

// The ports at which connections enter and leave each folded group.
function foldedPorts(edges: Chain[], found: Tree, names: Map<string, ElementView>): Map<string, Border> {
  const borders = new Map<string, Border>();
  const add = (group: Branch | null, side: "inputs" | "outputs", element: string, port: string) => {
    if (group === null) {
      return;
    }
    const border = borders.get(group.key) ?? NO_BORDER;
    const shown = border[side];
    const known = shown.some((one) => one.element === element && one.port === port);
    if (!known && shown.length < MOST_PORTS) {
      const path = `${names.get(element)?.path ?? element}.${port}`;
      borders.set(group.key, { ...border, [side]: [...shown, { element, port, path }] });
    }
  };
  for (const edge of edges) {
    const [from, to] = [hiddenBy(found, edge.source), hiddenBy(found, edge.target)];
    if (from === null || from !== to) {
      add(from, "outputs", edge.source, edge.source_port);
      add(to, "inputs", edge.target, edge.target_port);
    }
  }
  return borders;
}

// Edges of elements in folded groups end at the group; those that then run between the same two ports become
// one, with their number.
function wiresOf(edges: Chain[], found: Tree, names: Map<string, ElementView>): Wire[] {
  const wires = new Map<string, Wire>();
  for (const edge of edges) {
    const [from, to] = [hiddenBy(found, edge.source), hiddenBy(found, edge.target)];
    if (from !== null && from === to) {
      continue;
    }
    const source = from === null ? edge.source : groupNode(from.key);
    const target = to === null ? edge.target : groupNode(to.key);
    const sourceHandle = from === null ? edge.source_port : null;
    const targetHandle = to === null ? edge.target_port : null;
    const id =
      from === null && to === null ? edge.id : [source, sourceHandle, target, targetHandle].join(" ");
    const known = wires.get(id)?.data;
    if (known !== undefined) {
      known.sign = together(known.sign, edge.sign);
      known.count += 1;
      known.chains.push(edge);
      known.pills = [];
      known.revealed = [];
      known.room = COUNT;
      continue;
    }
    const data = {
      pills: edge.couplings,
      reads: edge.reads,
      sign: edge.sign,
      shared: false,
      count: 1,
      room: widthOf(edge, names),
      course: null,
      chains: [edge],
      content: null,
      revealed: edge.couplings,
    };
    const called = [
      from?.key ?? names.get(edge.source)?.path ?? edge.source,
      to?.key ?? names.get(edge.target)?.path ?? edge.target,
    ];
    const ariaLabel = called.join(" to ");
    wires.set(id, {
      id,
      type: "wire",
      source,
      target,
      sourceHandle,
      targetHandle,
      data,
      ariaLabel,
      focusable: false,
      zIndex: 1,
    });
  }
  const all = [...wires.values()];
  const end = (wire: Wire) => [wire.target, wire.targetHandle].join(" ");
  const arrows = new Set(all.filter(({ data }) => data?.sign !== "-").map(end));
  for (const wire of all) {
    if (wire.data !== undefined) {
      wire.data.shared = arrows.has(end(wire));
      wire.ariaLabel += signText(wire.data.sign);
    }
  }
  return all;
}

// The folded groups that hide an element, so that it can be shown.
export function foldedAround(found: Tree, element: string): string[] {
  return foldedKeys(around(found, element));
}

// The folded groups that hide a group.
export function foldedOutside(found: Tree, group: string): string[] {
  return foldedKeys(outside(found, group));
}

const foldedKeys = (groups: Branch[]): string[] =>
  groups.filter((group) => group.folded).map((group) => group.key);
