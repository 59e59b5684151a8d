import { expect, test } from "vitest";

import { addressed } from "./addressed";

test("edits name the document that they are meant for", () => {
  expect(addressed({ type: "undo" }, 7)).toEqual({ type: "undo", session: 7 });
  expect(addressed({ type: "set", element: "a", parameter: "tau", value: 3 }, 7)).toMatchObject({
    session: 7,
    value: 3,
  });
  expect(addressed({ type: "save" }, 7)).toMatchObject({ session: 7 });
});

test("edits of an axis and worlds name it too: another document may have an axis of the same key", () => {
  const axis = { name: "x", lower: 0, upper: 1, samples: 5 };
  expect(addressed({ type: "change_axis", key: "x", axis }, 7)).toMatchObject({ session: 7 });
  expect(addressed({ type: "use_world", kind: "Arena", path: "z" }, 7)).toMatchObject({ session: 7 });
  expect(addressed({ type: "leave_trial" }, 7)).toMatchObject({ session: 7 });
});

test("messages that open another document or edit none name no document", () => {
  for (const type of ["play", "measure_costs"] as const) expect(addressed({ type }, 7)).toEqual({ type });
  expect(addressed({ type: "open_file", path: "a.json" }, 7)).toEqual({ type: "open_file", path: "a.json" });
});
