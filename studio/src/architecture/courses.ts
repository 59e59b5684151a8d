// The courses of all wires of a scene: past the boxes, and across few other wires.

import type { Rect } from "../model/rects";
import { labelPlaces } from "./labels";
import { type GraphScene, PORT, STATED } from "./scene";
import { rectsOf, type SceneNode, type Wire, type WireData } from "./nodes";
import { type Route, Tracks } from "./tracks";
import { goesBack, turns, type WireLine } from "./turns";
import { type Course, courseOf } from "./wirePath";

// Every wire is led again once the courses of all others are known.
const ROUNDS = 2;

// The wires of a scene with their courses.
export function withCourses({ nodes, wires }: GraphScene): Wire[] {
  const rects = rectsOf(nodes);
  const boxes = nodes.flatMap(({ id, type }) => (type === "frame" ? [] : [rects.get(id) as Rect]));
  const rooms = new Map(wires.map(({ id, data }) => [id, roomOf(data)]));
  const found = courses(endsOf(wires, nodes, rects), boxes, rooms);
  return wires.map((wire) =>
    wire.data === undefined ? wire : { ...wire, data: { ...wire.data, course: found.get(wire.id) ?? null } },
  );
}

// A wire of one connection has a strength: 1 is shown below the pointer alone, and takes what others leave.
const PLAIN = 20;

// The width of what is drawn on a wire.
export function roomOf(data: WireData | undefined): number {
  const { chains: [chain, ...others] = [], room = 0, content = null } = data ?? {};
  if (chain === undefined || others.length > 0) {
    return room;
  }
  return Math.max(room + (chain.gain !== null && content === null ? STATED : 0), PLAIN);
}

// `rooms` are the widths of what is drawn on wires.
export function courses(wires: WireLine[], boxes: Rect[], rooms: Map<string, number>): Map<string, Course> {
  if (wires.length === 0) {
    return new Map();
  }
  const tracks = new Tracks(
    boxes,
    wires.flatMap(({ from, to }) => [from, to]),
  );
  const found = turns(wires, routed(wires, tracks), tracks);
  const drawn = wires.flatMap(({ id, from, to }) => {
    const own = found.get(id);
    return own === undefined ? [] : [{ id, from, to, turns: own, room: rooms.get(id) ?? 0 }];
  });
  const labels = labelPlaces(drawn, boxes);
  return new Map(
    drawn.map(({ id, from, to, turns: own }) => {
      const course = courseOf(from, to, own);
      return [id, { ...course, middle: labels.get(id) ?? course.middle }];
    }),
  );
}

// Net by net, those that reach least far first: wires of one net do not cross each other.
function routed(wires: WireLine[], tracks: Tracks): Map<string, Route> {
  const nets = new Map<string, WireLine[]>();
  for (const wire of wires) {
    nets.set(wire.net, [...(nets.get(wire.net) ?? []), wire]);
  }
  const reach = (net: WireLine[]) => Math.max(...net.map(({ from, to }) => Math.abs(to.x - from.x)));
  const order = [...nets.values()].sort((a, b) => reach(a) - reach(b));
  const found = new Map<string, Route>();
  const count = (net: WireLine[], sign: 1 | -1) => {
    for (const { id } of net) {
      const route = found.get(id);
      if (route !== undefined) {
        tracks.add(route, sign);
      }
    }
  };
  for (let round = 0; round < ROUNDS; round++) {
    for (const net of order) {
      count(net, -1);
      for (const { id, from, to } of net) {
        const route = tracks.route(from, to, goesBack(from, to));
        if (route !== null) {
          found.set(id, route);
        }
      }
      count(net, 1);
    }
  }
  return found;
}

function endsOf(wires: Wire[], nodes: SceneNode[], rects: Map<string, Rect>): WireLine[] {
  const known = new Map(nodes.map((node) => [node.id, node]));
  const port = (id: string, type: "source" | "target", handle: string | null | undefined) => {
    const found = known
      .get(id)
      ?.handles?.find((one) => one.type === type && (one.id ?? null) === (handle ?? null));
    const { x = 0, y = 0 } = rects.get(id) ?? {};
    return found === undefined
      ? null
      : { x: x + found.x + (type === "source" ? PORT : 0), y: y + found.y + PORT / 2 };
  };
  const taken = new Set<string>();
  return wires.flatMap(({ id, source, target, sourceHandle, targetHandle, data }) => {
    const from = port(source, "source", sourceHandle);
    const to = port(target, "target", targetHandle);
    if (from === null || to === null) {
      return [];
    }
    // Wires between the same two ports, and those of different looks, are apart.
    const net = [source, sourceHandle, data?.sign, data?.reads].join(" ");
    const pair = [net, target, targetHandle].join(" ");
    const alone = taken.has(pair);
    taken.add(pair);
    return [{ id, net: alone ? id : net, from, to }];
  });
}
