import { describe, expect, test } from "vitest";

import type { Kind, ParameterForm } from "../protocol";
import type { Kinds } from "./leaf";
import { fresh, moved, recast, same, summary, symbolOf, without, words } from "./part";

const form = (name: string, of: ParameterForm["form"] = "number"): ParameterForm =>
  ({ name, form: of, cost: "live", unit: "", default: 0, choices: [], of: [] }) as unknown as ParameterForm;

const kind = (name: string, parameters: ParameterForm[], example: unknown): [string, Kind] => [
  name,
  { name, title: name, parameters, example } as unknown as Kind,
];

const kinds: Kinds = new Map([
  kind("Hill", [form("height"), form("full_width", "per_axis"), form("flat", "flag")], {
    kind: "Hill",
    height: 1,
    full_width: 5,
    flat: false,
  }),
  kind("Valley", [form("height"), form("full_width"), form("slope")], {
    kind: "Valley",
    height: -1,
    full_width: 3,
    slope: 2,
  }),
]);

describe("the summary of a part", () => {
  test("contains its first numbers", () =>
    expect(summary(kinds, { kind: "Hill", height: 12, full_width: [5, 3], flat: true })).toBe(
      "height 12, full width 5 × 3",
    ));
  test("is empty for an unknown kind", () =>
    expect(summary(kinds, { kind: "Stranger", height: 1 })).toBe(""));
  test("is empty without a part", () => expect(summary(kinds, null)).toBe(""));
});

describe("another kind for a part", () => {
  test("parameters of both kinds keep their values if their forms are equal", () => {
    expect(recast(kinds, "Valley", { kind: "Hill", height: 7, full_width: [1, 2], flat: true })).toEqual({
      kind: "Valley",
      height: 7,
      full_width: 3,
      slope: 2,
    });
  });
  test("without a part it starts from the example", () =>
    expect(recast(kinds, "Hill", null)).toEqual({ kind: "Hill", height: 1, full_width: 5, flat: false }));
});

test("items of a list are removed and moved", () => {
  expect(without(["a", "b", "c"], 1)).toEqual(["a", "c"]);
  expect(moved(["a", "b", "c"], 0, 2)).toEqual(["b", "c", "a"]);
  expect(moved(["a", "b", "c"], 2, 0)).toEqual(["c", "a", "b"]);
  expect(moved(["a", "b"], 0, -1)).toEqual(["a", "b"]);
  expect(moved(["a", "b"], 1, 2)).toEqual(["a", "b"]);
});

test("a new name differs from the names in use", () => {
  expect(fresh([])).toBe("name");
  expect(fresh(["name", "name2"])).toBe("name3");
});

test.each([
  [1, 1, true],
  [1, 2, false],
  [null, undefined, true],
  [[1, 2], [1, 2], true],
  [[1], { 0: 1 }, false],
  [{ kind: "Hill", height: 1 }, { height: 1, kind: "Hill" }, true],
  [{ height: 1 }, { width: 1 }, false],
])("%j and %j are the same: %s", (a, b, answer) => expect(same(a, b)).toBe(answer));

test("names are shown as words", () => expect(words("resting_level")).toBe("resting level"));

test.each([
  ["tau", "\\tau", "\\tau"],
  ["amplitude", "\\mathrm{amplitude}", ""],
  ["spread_out", "\\mathrm{spread\\_out}", ""],
  ["k", "k", ""],
  ["other", "", ""],
])("the symbol of %s, written %s, is shown as %s", (name, symbol, shown) =>
  expect(symbolOf({ ...form(name), symbol })).toBe(shown),
);
