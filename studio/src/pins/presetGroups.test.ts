import { expect, test } from "vitest";

import { choiceText, presetGroups } from "./presetGroups";

const off = { name: "go: off", group: "go" };
const on = { name: "go: on", group: "go" };
const calm = { name: "calm", group: "Select" };

test("presets are listed by their groups, in the order of the document", () => {
  const groups = presetGroups([off, calm, on]);
  expect(groups.map(({ group, presets }) => [group, presets.map(choiceText)])).toEqual([
    ["go", ["off", "on"]],
    ["Select", ["calm"]],
  ]);
});
