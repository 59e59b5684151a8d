import { expect, test } from "vitest";

import { fakeConnections, fakeDocument, fakeElement, fakeKind, kindsOf } from "../architecture/fakes";
import { boxesOf, overlaps, type Point } from "../model/rects";
import { scene } from "../architecture/scene";
import type { CommentView } from "../protocol";
import { areNear } from "./placing";
import { onWire } from "./room";

const BOX = { width: 156, height: 104 };

type DrawnModel = {
  boxes: Record<string, Point>;
  wires: string[];
  groups?: string[][];
  comments?: Record<string, CommentView>;
};

function drawn({ boxes, wires, groups = [], comments = {} }: DrawnModel) {
  const elements = Object.keys(boxes).map((path) => fakeElement(path, "Field", { axes: { output: ["x"] } }));
  const layout = { boxes, comments };
  return scene(
    fakeDocument(elements, fakeConnections(...wires), { groups, layout }),
    kindsOf(fakeKind("Field", "elements")),
  );
}

/** A new box in the first wire, at the middle of its gap. */
function inserted(now: ReturnType<typeof drawn>, size = BOX, dragged?: string) {
  const wire = now.wires[0];
  const [from, to] = [wire?.source, wire?.target].map((id) => now.places.elements.get(id ?? ""));
  if (wire === undefined || from === undefined || to === undefined) throw new Error("no wire");
  const middle = { x: (from.x + BOX.width + to.x) / 2 - size.width / 2, y: from.y };
  const made = onWire(wire, middle, size, now, dragged);
  if (made === null) throw new Error("the wire leads to the left");
  const at = (id: string) => made.moves.boxes.get(id) ?? { x: NaN, y: NaN };
  return { made, at };
}

const chain = { a: { x: 0, y: 0 }, b: { x: 248, y: 0 }, c: { x: 500, y: 0 }, away: { x: 248, y: 300 } };

test("a box of 132 px in a gap of 92 moves what is downstream by 112, and nothing else", () => {
  const { made, at } = inserted(drawn({ boxes: chain, wires: ["a b c"] }), { width: 132, height: 104 });
  expect(made.at).toEqual({ x: 156 + 36, y: 0 });
  expect(at("b")).toEqual({ x: 248 + 112, y: 0 });
  expect(at("c")).toEqual({ x: 500 + 112, y: 0 });
  expect(at("a")).toEqual(chain.a);
  expect(at("away")).toEqual(chain.away);
});

test("a wide gap moves nothing, and a second box in the same wire makes its room again", () => {
  const wide = { ...chain, b: { x: 400, y: 0 }, c: { x: 700, y: 0 } };
  const first = inserted(drawn({ boxes: wide, wires: ["a b c"] }));
  expect(first.made.at).toEqual({ x: 200, y: 0 });
  expect(first.at("b")).toEqual(wide.b);
  const boxes = { ...wide, n: first.made.at };
  const second = inserted(drawn({ boxes, wires: ["a n b c"] }));
  expect(second.made.at).toEqual({ x: 192, y: 0 });
  expect(second.at("n").x).toBe(192 + BOX.width + 36);
  expect(second.at("b").x - second.at("n").x).toBe(wide.b.x - first.made.at.x);
});

test("what is in the way is pushed on only as far as needed, and what flows back stays", () => {
  const boxes = { ...chain, other: { x: 780, y: 20 }, far: { x: 1300, y: 0 } };
  const { at } = inserted(drawn({ boxes, wires: ["a b c a"] }));
  const right = at("c").x + BOX.width;
  expect(at("other")).toEqual({ x: right + 24, y: 20 });
  expect(at("far")).toEqual(boxes.far);
  expect(at("a")).toEqual(chain.a);
});

test("a group in which room is made grows, and pushes what is beside it", () => {
  const boxes = {
    "g.a": { x: 0, y: 0 },
    "g.b": { x: 248, y: 0 },
    beside: { x: 450, y: 0 },
    below: { x: 450, y: 600 },
  };
  const now = drawn({ boxes, wires: ["g.a g.b"], groups: [["g"]] });
  const { made, at } = inserted(now);
  expect(made.group).toBe("g");
  expect(at("g.b").x).toBe(156 + 36 + BOX.width + 36);
  expect(at("beside").x).toBeGreaterThanOrEqual(at("g.b").x + BOX.width + 28 + 18);
  expect(at("below")).toEqual(boxes.below);
});

test("a whole group downstream moves together, open or folded", () => {
  const boxes = { a: { x: 0, y: 0 }, "g.b": { x: 276, y: 0 }, "g.h.c": { x: 560, y: 40 } };
  for (const folded of [[], ["g"], ["g/h"]]) {
    const now = scene(
      fakeDocument(
        Object.keys(boxes).map((path) => fakeElement(path, "Field", { axes: { output: ["x"] } })),
        fakeConnections("a g.b g.h.c"),
        { groups: [["g"], ["g", "h"]], layout: { boxes, folded } },
      ),
      kindsOf(fakeKind("Field", "elements")),
    );
    const wire = now.wires.find(({ source }) => source === "a");
    const made = wire === undefined ? null : onWire(wire, { x: 150, y: 0 }, BOX, now);
    const by = (id: "g.b" | "g.h.c") => (made?.moves.boxes.get(id)?.x ?? NaN) - boxes[id].x;
    expect(by("g.b"), folded.join()).toBeGreaterThan(100);
    expect(by("g.h.c")).toBe(by("g.b"));
    expect(made?.group).toBe("");
  }
});

test("a comment moves with the box that it is nearest to", () => {
  const comments = {
    one: { text: "b", x: 248, y: 120, width: 120, height: 40 },
    two: { text: "a", x: 0, y: 120, width: 120, height: 40 },
  };
  const { made, at } = inserted(drawn({ boxes: chain, wires: ["a b c"], comments }));
  expect(made.moves.comments.get("one")).toEqual({ x: at("b").x, y: 120 });
  expect(made.moves.comments.get("two")).toEqual({ x: 0, y: 120 });
});

test("a wire that leads back makes no room, and a box in the gap is not covered", () => {
  const back = drawn({ boxes: { a: { x: 300, y: 0 }, b: { x: 0, y: 0 } }, wires: ["a b"] });
  expect(onWire(back.wires[0] as (typeof back.wires)[0], { x: 0, y: 0 }, BOX, back)).toBeNull();
  const between = { a: { x: 0, y: 0 }, b: { x: 500, y: 0 }, in: { x: 250, y: 40 } };
  const { made } = inserted(drawn({ boxes: between, wires: ["a b"] }));
  expect(areNear({ ...made.at, ...BOX }, { ...between.in, ...BOX })).toBe(false);
});

test("the box that is dropped is no obstacle of its own", () => {
  const boxes = { ...chain, n: { x: 160, y: 10 } };
  const { made, at } = inserted(drawn({ boxes, wires: ["a b c"] }), BOX, "n");
  expect(made.at).toEqual({ x: 192, y: 0 });
  expect(at("b").x).toBe(192 + BOX.width + 36);
  expect(made.moves.boxes.has("n")).toBe(false);
});

test("1000 inserts into wires of random documents leave no overlap", () => {
  let state = 11;
  const draw = (most: number) => {
    state = (state * 16807) % 2147483647;
    return state % most;
  };
  for (let document = 0; document < 50; document++) {
    const boxes: Record<string, Point> = {};
    for (let i = 0; i < 8; i++) boxes[`e${i}`] = { x: 200 * (i % 4), y: 160 * Math.floor(i / 4) };
    const wires = Array.from({ length: 8 }, () => `e${draw(8)} e${draw(8)}`).filter((wire) => {
      const [one, other] = wire.split(" ");
      return one !== other;
    });
    for (let step = 0; step < 20; step++) {
      const now = drawn({ boxes, wires: [...new Set(wires)] });
      const wire = now.wires[draw(now.wires.length)];
      const made = wire && onWire(wire, { x: draw(900), y: draw(400) }, BOX, now);
      if (wire === undefined || made == null) continue;
      const name = `n${step}`;
      for (const [id, at] of made.moves.boxes) boxes[id] = at;
      boxes[name] = made.at;
      wires.splice(wires.indexOf(`${wire.source} ${wire.target}`), 1);
      wires.push(`${wire.source} ${name}`, `${name} ${wire.target}`);
    }
    expect(overlaps(boxesOf(new Map(Object.entries(boxes)), BOX)), `document ${document}`).toEqual([]);
  }
}, 60_000);
