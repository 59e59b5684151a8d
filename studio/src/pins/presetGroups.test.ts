import { expect, test } from "vitest";

import { choiceText, presetGroups } from "./presetGroups";

const off = { name: "go: off", group: "go", values: {} };
const on = { name: "go: on", group: "go", values: { a: { amplitude: 6 } } };
const calm = { name: "calm", group: "Select", values: {} };

test("presets are listed by their groups, in the order of the document", () => {
  const groups = presetGroups({ presets: [off, calm, on] });
  expect(groups.map(({ group, presets }) => [group, presets.map(choiceText)])).toEqual([
    ["go", ["off", "on"]],
    ["Select", ["calm"]],
  ]);
});

test("invalid presets are skipped, and of equal names the first one counts", () => {
  const damaged = [null, 3, {}, { name: "", group: "g", values: {} }, { name: "x", group: 2, values: {} }];
  const more = [
    { name: "y", values: 3 },
    { ...on, group: "other" },
    { name: "alone", values: {} },
  ];
  expect(presetGroups({ presets: [...damaged, on, ...more] })).toEqual([
    { group: "go", presets: [{ name: "go: on", group: "go" }] },
    { group: "", presets: [{ name: "alone", group: "" }] },
  ]);
  expect(presetGroups(undefined)).toEqual([]);
  expect(presetGroups({ presets: "nonsense" })).toEqual([]);
});

test("the same layout gives the same groups, so that nothing is drawn again", () => {
  const layout = { presets: [off] };
  expect(presetGroups(layout)).toBe(presetGroups({ ...layout }));
});
