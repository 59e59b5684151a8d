import { expect, test } from "vitest";

import { restored } from "./person";

const FIRST = { dock: 0, palette: true, tabs: {}, views: {} };

test("a stored value counts where it has the type of its default", () => {
  expect(restored("{}")).toEqual(FIRST);
  expect(restored('{"dock": 400, "palette": false, "tabs": {"run": "regime"}}')).toEqual({
    ...FIRST,
    dock: 400,
    palette: false,
    tabs: { run: "regime" },
  });
  for (const text of ["", "null", "3", '{"dock": "wide", "palette": 1, "tabs": null, "more": 2}']) {
    expect(restored(text), text).toEqual(FIRST);
  }
});
