import { expect, test } from "vitest";

import { fakeDocument, fakeElement, kindsOf, fakeKind } from "../architecture/fakes";
import { scene } from "../architecture/scene";
import type { Point } from "../model/rects";
import { extentOf } from "./extent";
import {
  afterAll,
  areNear,
  atEnd,
  beside,
  between,
  dropGroupAt,
  free,
  freePlace,
  near,
  NEW_BOX,
  pathOf,
  under,
} from "./placing";

const elements = [fakeElement("u"), fakeElement("v"), fakeElement("g.w")];
const layout = { boxes: { u: { x: 0, y: 0 }, v: { x: 228, y: 0 }, "g.w": { x: 1000, y: 1000 } } };
const made = scene(
  fakeDocument(elements, [], { groups: [["g"]], layout }),
  kindsOf(fakeKind("Field", "elements")),
);

test("a new box has its name below the pointer", () => {
  const { at, group } = under({ x: 400, y: 300 }, made);
  expect(Math.abs(at.x - (400 - NEW_BOX.width / 2)), "the grid").toBeLessThanOrEqual(6);
  expect(Math.abs(at.y - 280)).toBeLessThanOrEqual(6);
  expect(group).toBe("");
});

test("inside the frame of a group a new element belongs to the group", () => {
  expect(under({ x: 1010, y: 1050 }, made).group).toBe("g");
  expect(pathOf("g", { groups: [["g"]], elements: [] })).toEqual(["g"]);
  expect(pathOf("a/b", { groups: [["a/b"]], elements: [] })).toEqual(["a/b"]);
});

test("a box is dropped into the innermost group at the pointer, a group into none of its own", () => {
  const boxes = { "g.w": { x: 0, y: 0 }, "g.h.v": { x: 300, y: 0 }, "f.u": { x: 900, y: 0 } };
  const nested = scene(
    fakeDocument([fakeElement("g.w"), fakeElement("g.h.v"), fakeElement("f.u")], [], {
      groups: [["g"], ["g", "h"], ["f"]],
      layout: { boxes, folded: ["f"] },
    }),
    kindsOf(fakeKind("Field", "elements")),
  );
  const inner = { x: 310, y: 10 };
  expect(dropGroupAt(inner, nested, [])).toBe("g/h");
  expect(dropGroupAt({ x: 10, y: 10 }, nested, [])).toBe("g");
  expect(dropGroupAt(inner, nested, ["g/h"]), "a group does not move into itself").toBe("g");
  expect(dropGroupAt(inner, nested, ["g"]), "nor into one inside it").toBe("");
  expect(dropGroupAt({ x: 890, y: -20 }, nested, [])).toBe("f");
  expect(dropGroupAt({ x: 0, y: 5000 }, nested, [])).toBe("");
});

test("beside a box a new one takes the next free place", () => {
  expect(beside("v", true, made).at).toEqual({ x: 228 + NEW_BOX.width + 72, y: 0 });
  expect(beside("u", true, made).at.y, "v is in the way").toBeGreaterThanOrEqual(NEW_BOX.height);
  expect(near({ x: NEW_BOX.width / 2, y: NEW_BOX.height / 2 }, made).at.y).toBeGreaterThan(0);
});

test("where boxes lie, a new one is as near as the gap lets it, below rather than above", () => {
  const box = { x: 0, y: 0, ...NEW_BOX };
  expect(freePlace({ x: 5, y: -5 }, NEW_BOX, () => true)).toEqual({ x: 0, y: 0 });
  const below = freePlace({ x: 0, y: 0 }, NEW_BOX, (rect) => !areNear(rect, box)) ?? { x: 1, y: 0 };
  expect(below.x).toBe(0);
  expect(below.y - NEW_BOX.height).toBeGreaterThanOrEqual(24);
  expect(below.y - NEW_BOX.height).toBeLessThan(36);
});

// Random numbers that every run draws alike.
function drawing(seed: number): () => number {
  let state = seed;
  return () => {
    state = (state * 16807) % 2147483647;
    return state / 2147483647;
  };
}

// A document that grows by placings, as a person makes them without looking where boxes lie.
class Growing {
  readonly elements: ReturnType<typeof fakeElement>[] = [];
  readonly boxes: Record<string, Point> = {};
  readonly groups: string[][] = [];
  private readonly kinds = kindsOf(fakeKind("Field", "elements"));
  private readonly outputs = ["output", "activation", "interaction", "bounded"];

  scene() {
    const { boxes, groups } = this;
    return scene(fakeDocument(this.elements, [], { groups, layout: { boxes } }), this.kinds);
  }

  add(at: Point, group = ""): void {
    const path = `${group === "" ? "" : `${group}.`}e${this.elements.length}`;
    this.elements.push(fakeElement(path, "Field", { outputs: this.outputs }));
    this.boxes[path] = at;
  }

  // Two boxes, one beside and below the other, as a copy has them.
  paste(wish: Point): void {
    const boxes = { a: { x: 500, y: 300 }, b: { x: 700, y: 460 } };
    const copied = { a: { id: "a", kind: "Field" }, b: { id: "b", kind: "Field" } };
    const whole = extentOf(JSON.stringify({ elements: copied, layout: { boxes } }), new Map());
    if (whole === null) throw new Error("the copy has positions");
    const { at } = free(wish, { ...whole.size, height: whole.size.height + 40 }, "", this.scene());
    this.add(at);
    this.add({ x: at.x + 200, y: at.y + 160 });
  }

  template(wish: Point): void {
    const group = `t${this.groups.length}`;
    const { at } = afterAll(this.scene()) ?? { at: wish };
    this.groups.push([group]);
    this.add(at, group);
    this.add({ x: at.x + 240, y: at.y }, group);
  }
}

test("of 1000 adds, pastes, templates and inserts none overlaps a box, and gaps are at least 24", () => {
  const draw = drawing(7);
  const size = { width: NEW_BOX.width, height: 120 };
  let count = 0;
  for (let document = 0; document < 50; document++) {
    const growing = new Growing();
    for (let step = 0; step < 20; step++, count++) {
      const now = growing.scene();
      const ids = growing.elements.map(({ id }) => id);
      const [one = "", other = ""] = [
        ids[Math.floor(draw() * ids.length)],
        ids[Math.floor(draw() * ids.length)],
      ];
      const wish = { x: 400 + 500 * draw(), y: 200 + 300 * draw() };
      const which = ids.length === 0 ? 0 : Math.floor(draw() * 7);
      if (which === 4) growing.paste(wish);
      else if (which === 5) growing.template(wish);
      else {
        const ways = [
          () => under(wish, now, size),
          () => beside(one, draw() > 0.5, now, size),
          () => near(wish, now, size),
          () => atEnd(wish, draw() > 0.5, now, size),
        ];
        const placing =
          which === 6 ? between(one, other, now, size) : (ways[which]?.() ?? near(wish, now, size));
        growing.add(placing.at, placing.group);
      }
    }
    const rects = growing.scene().nodes.flatMap(({ id, width = 0, height = 0 }) => {
      const at = growing.scene().places.elements.get(id);
      return at === undefined ? [] : [{ ...at, width, height }];
    });
    const crowded = rects.flatMap((a, i) => rects.slice(i + 1).filter((b) => areNear(a, b)));
    expect(crowded, `document ${document}`).toEqual([]);
  }
  expect(count).toBe(1000);
}, 60_000);
