import { expect, test } from "vitest";

import { fakeForm, fakeKind } from "../architecture/fakes";
import type { ParameterForm } from "../protocol";
import { add, type Data, partsOf, put, remove, rename, setAt } from "./draft";

const form = (name: string, more: Partial<ParameterForm> = {}) => fakeForm(name, "number", more);
const kind = (name: string, parameters: ParameterForm[]) => fakeKind(name, "experiments", { parameters });
const KINDS = [
  kind("Seen", [form("field")]),
  kind("Both", [form("of", { names: "event" })]),
  kind("Change", [form("when", { names: "event" }), form("path", { names: "parameter" })]),
  kind("Usual", [form("when", { names: "event" })]),
];

test("a part gets a name that no other column has", () => {
  const once = add({ name: "e" }, "conditions", { kind: "Seen" }, "seen");
  const twice = add(add(once, "measures", {}, "seen"), "conditions", { kind: "Seen" }, "seen");
  expect(partsOf(twice, "conditions").map(({ key }) => key)).toEqual(["seen", "seen3"]);
  expect(Object.keys(twice["measures"] as object)).toEqual(["seen2"]);
  expect(partsOf(add(twice, "actions", { kind: "Change" }, "change"), "actions")).toEqual([
    { key: "0", values: { kind: "Change" } },
  ]);
});

test("the last part of a group takes the group with it", () => {
  const data = add({ name: "e" }, "factors", {}, "f");
  expect(remove(data, "factors", "f")).toEqual({ name: "e" });
  expect(put(data, "factors", "f", { path: "a" })).toEqual({ name: "e", factors: { f: { path: "a" } } });
});

test("what names an event follows its new name, and nothing else does", () => {
  const data: Data = {
    conditions: { a: { kind: "Seen", field: "a" }, both: { kind: "Both", of: ["a", "b"] } },
    actions: [{ kind: "Change", when: "a", path: "a" }],
    measures: { m: { when: "a" } },
  };
  expect(rename(data, "conditions", "a", "c", KINDS)).toEqual({
    conditions: { c: { kind: "Seen", field: "a" }, both: { kind: "Both", of: ["c", "b"] } },
    actions: [{ kind: "Change", when: "c", path: "a" }],
    measures: { m: { when: "c" } },
  });
});

test("a default is not stored, and one of several numbers is set by its index", () => {
  const forms = [form("level", { default: 0 }), form("near", { form: "per_axis", optional: true })];
  const set = setAt({ near: [1, 2] }, forms, "near.1", 5);
  expect(set).toEqual({ near: [1, 5] });
  expect(setAt(setAt(set, forms, "level", 3), forms, "near", null)).toEqual({ level: 3 });
  expect(setAt({ level: 3 }, forms, "level", 0)).toEqual({});
});
