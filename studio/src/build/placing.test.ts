import { expect, test } from "vitest";

import { fakeDocument, fakeElement, kindsOf, fakeKind } from "../graph/fakes";
import { scene } from "../graph/scene";
import { beside, dropGroupAt, near, NEW_BOX, pathOf, under } from "./placing";

const elements = [fakeElement("u"), fakeElement("v"), fakeElement("g.w")];
const layout = { boxes: { u: { x: 0, y: 0 }, v: { x: 228, y: 0 }, "g.w": { x: 1000, y: 1000 } } };
const made = scene(
  fakeDocument(elements, [], { groups: [["g"]], layout }),
  kindsOf(fakeKind("Field", "elements")),
);

test("a new box has its name below the pointer", () => {
  const { at, group } = under({ x: 400, y: 300 }, made);
  expect(at).toEqual({ x: 400 - NEW_BOX.width / 2, y: 280 });
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
