import { expect, test } from "vitest";

import { fakeConnections, fakeDocument, fakeElement } from "./graph/fakes";
import { patched } from "./patch";
import type { ConnectionView, Edited } from "./protocol";
import { useStudio } from "./store";

function edited(change: Partial<Edited>): Edited {
  return {
    type: "edited",
    version: 2,
    elements: [],
    added: {},
    moved: {},
    removed: [],
    disconnected: [],
    connected: [],
    groups: null,
    axes: null,
    parameters: null,
    general: null,
    layout: {},
    layout_entries: {},
    problems: null,
    unsaved: true,
    undo: 1,
    redo: 0,
    cost: "recompile",
    ...change,
  };
}

const [u, v, w] = [fakeElement("u"), fakeElement("v"), fakeElement("w")];
const document = {
  ...fakeDocument([u, v], fakeConnections("u v")),
  layout: { boxes: { u: { x: 1, y: 2 }, v: { x: 3, y: 4 } }, pins: [1] },
};

test("an empty patch changes the numbers of steps alone", () => {
  const next = patched(document, edited({ undo: 4, redo: 2 }));
  expect(next).toEqual({ ...document, unsaved: true, undo: 4, redo: 2 });
  for (const key of ["elements", "connections", "layout", "groups", "axes", "problems"] as const) {
    expect(next[key]).toBe(document[key]);
  }
});

test("elements are removed, replaced, and inserted where the patch says", () => {
  const tuned = { ...v, values: { tau: 5 }, inputs: [...v.inputs], axes: { ...v.axes } };
  const next = patched(document, edited({ elements: [tuned, w], added: { w: 0 }, removed: ["u"] }));
  expect(next.elements).toEqual([w, tuned]);
  expect(next.connections).toEqual([]);
  expect(next.elements[1]?.inputs).toBe(v.inputs);
  expect(next.elements[1]?.axes).toBe(v.axes);
});

test("several new elements keep the order of the document", () => {
  const x = fakeElement("x");
  const next = patched(document, edited({ elements: [x, w], added: { x: 3, w: 1 } }));
  expect(next.elements.map((e) => e.id)).toEqual(["u", "w", "v", "x"]);
});

test("connections are cut, and inserted at their index", () => {
  const [first, second] = fakeConnections("v u", "v v") as [ConnectionView, ConnectionView];
  const grown = patched(
    document,
    edited({
      connected: [
        { index: 0, connection: first },
        { index: 2, connection: second },
      ],
    }),
  );
  expect(grown.connections).toEqual([first, ...document.connections, second]);
  const { reads: _, ...cut } = first;
  expect(patched(grown, edited({ disconnected: [cut] })).connections).toEqual([
    ...document.connections,
    second,
  ]);
});

test("entries of the layout change one by one, and null removes them", () => {
  const next = patched(
    document,
    edited({
      layout: { pins: null, folded: ["g"] },
      layout_entries: { boxes: { u: null, w: { x: 5, y: 6 } } },
    }),
  );
  expect(next.layout).toEqual({ boxes: { v: { x: 3, y: 4 }, w: { x: 5, y: 6 } }, folded: ["g"] });
  expect(document.layout.boxes).toHaveProperty("u");
});

test("general properties are replaced together", () => {
  const general = { title: "new", time_unit: "s", dt: 0.5, notes: "read this" };
  expect(patched(document, edited({ general }))).toMatchObject(general);
});

test("the store takes a patch: a removed element is no longer selected", () => {
  const { take, select } = useStudio.getState();
  take({ type: "opened", session: 1, version: 1, document });
  select(["u", "v"]);
  take(edited({ removed: ["u"], version: 7 }));
  const state = useStudio.getState();
  expect(state.version).toBe(7);
  expect(state.selected).toEqual(["v"]);
  expect([...state.elements.keys()]).toEqual(["v"]);
});

test("an element that only gets another path keeps its values", () => {
  const moved = { path: "g.v", name: "v", group: ["g"] };
  const after = patched(document, edited({ moved: { u: moved } }));
  expect(after.elements[0]).toEqual({ ...u, ...moved });
  expect(after.elements[0]?.values).toBe(u.values);
  expect(after.elements[1]).toBe(v);
});
