import { expect, it } from "vitest";

import { fakeElement } from "../architecture/fakes";
import type { Costs } from "../protocol";
import { costRows, microsecondsText, sumOf } from "./costRows";

const cost = (element: string, us: number, alike = 1, once = false) => ({
  element,
  path: `old ${element}`,
  kind: "Field",
  us,
  alike,
  once,
});
const costs: Costs = {
  type: "costs",
  measuring: false,
  step: 5,
  elements: [cost("u", 3), cost("v", 1, 2), cost("s", 0, 1, true)],
  problems: [],
};

it("a row shows the current path of its element, its time, its share and a bar", () => {
  const u = { ...fakeElement("u"), id: "u", path: "group.u" };
  const rows = costRows(costs, new Map([["u", u]]));
  expect(sumOf(costs)).toBe(4);
  expect(rows[0]).toMatchObject({
    element: "u",
    path: "group.u",
    time: "3.00",
    share: "75.0 %",
    bar: 1,
    about: "Computed alone",
  });
  expect(rows[1]).toMatchObject({ element: null, path: "old v", share: "25.0 %" });
  expect(rows[1]?.about).toContain("with 1 of the same structure");
  expect(rows[2]).toMatchObject({ time: "once", share: "", bar: 0 });
  expect(rows[2]?.about).toContain("Constant");
  expect(new Set(rows.map((row) => row.key)).size).toBe(3);
});

it("an empty measurement and a cost of zero cause no division by zero", () => {
  expect(costRows({ ...costs, elements: [] }, new Map())).toEqual([]);
  expect(costRows({ ...costs, elements: [cost("u", 0)] }, new Map())[0]).toMatchObject({
    share: "",
    bar: 0,
    time: "0.00",
  });
});

it("times have three significant digits", () => {
  expect([0.0312, 1.234, 9.996, 45.62, 1234.4].map(microsecondsText)).toEqual([
    "0.03",
    "1.23",
    "10.0",
    "45.6",
    "1234",
  ]);
});
