import { expect, it } from "vitest";

import type { ImportReportView, ReportLineView } from "../protocol";
import { countOf, lossesText, reportItems } from "./reportItems";

const line = (where: string, what: string, more: Partial<ReportLineView> = {}): ReportLineView => ({
  where,
  element: where === "" ? "" : `id of ${where}`,
  part: "parameter",
  what,
  verdict: "carried",
  why: "",
  group: [],
  ...more,
});
const report: ImportReportView = {
  type: "import_report",
  tool: "cedar",
  file: "memory.json",
  bugs: [],
  lines: [
    line("", "step", { part: "file", verdict: "approximated", why: "20 ms" }),
    line("field", "time scale"),
    line("field", "sigmoid", { verdict: "dropped", why: "it is unknown" }),
    line("robot", "host", { verdict: "dropped" }),
    line("default thread", "time step", { element: "" }),
    line("field", "field.output", { part: "connection", verdict: "approximated" }),
  ],
};
const paths = { elements: new Map([["id of field", "perception.u"]]), groups: new Set<string>() };

it("lines are grouped by element, which has its present path, and the name in the file beside it", () => {
  const items = reportItems(report, paths, "all", "");
  expect(items.map(({ title, note, goal }) => [title, note, goal])).toEqual([
    ["The file as a whole", "", null],
    ["perception.u", "field in the file", { element: "id of field" }],
    ["robot", "removed from the document", null],
    ["default thread", "no element of the document", null],
  ]);
  expect(items[1]?.lines.map(({ what }) => what)).toEqual(["time scale", "sigmoid", "field.output"]);
  const keys = items.flatMap(({ lines }) => lines.map(({ key }) => key));
  expect(new Set(keys).size).toBe(report.lines.length);
});

it("an element that has the name of the file needs no note", () => {
  const same = { ...paths, elements: new Map([["id of field", "field"]]) };
  expect(reportItems(report, same, "all", "field")[0]?.note).toBe("");
});

it("a filter leaves the lines of a verdict, and no empty items", () => {
  const shown = (filter: Parameters<typeof reportItems>[2]) =>
    reportItems(report, paths, filter, "").map(({ title, lines }) => [title, lines.length]);
  expect(shown("losses")).toEqual([
    ["The file as a whole", 1],
    ["perception.u", 2],
    ["robot", 1],
  ]);
  expect(shown("approximated")).toEqual([
    ["The file as a whole", 1],
    ["perception.u", 1],
  ]);
  expect(shown("dropped")).toEqual([
    ["perception.u", 1],
    ["robot", 1],
  ]);
});

it("counts are those of the whole report, and carried lines are no losses", () => {
  expect((["losses", "approximated", "dropped", "all"] as const).map((one) => countOf(report, one))).toEqual([
    4, 2, 2, 6,
  ]);
  expect(lossesText(report)).toBe("2 approximated, 2 dropped");
  expect(lossesText({ ...report, lines: report.lines.slice(0, 2) })).toBe("1 approximated");
  expect(lossesText({ ...report, lines: report.lines.slice(1, 2) })).toBe("");
});

it("a search finds words of a line, and the name of its element, now and in the file", () => {
  const found = (search: string) =>
    reportItems(report, paths, "all", search).flatMap(({ lines }) => lines.map(({ what }) => what));
  expect(found("UNKNOWN sigmoid")).toEqual(["sigmoid"]);
  expect(found("perception dropped")).toEqual(["sigmoid"]);
  expect(found("field connection")).toEqual(["field.output"]);
  expect(found("nothing of the sort")).toEqual([]);
});

it("lines of a group lead to it while it has its name, then to its first element", () => {
  const group = ["outer", "in.ner"];
  const lines = [line("outer.in.ner", "a", { part: "connection", element: "id of field", group })];
  const shown = (elements: [string, string][], groups: string[]) =>
    reportItems(
      { ...report, lines },
      { elements: new Map(elements), groups: new Set(groups) },
      "all",
      "",
    ).map(({ title, note, goal }) => [title, note, goal]);
  const first: [string, string] = ["id of field", "outer.other.u"];
  expect(shown([first], ["outer", "outer/in.ner"])).toEqual([
    ["outer.in.ner", "group", { group: "outer/in.ner" }],
  ]);
  expect(shown([], ["outer/in.ner"])).toEqual([["outer.in.ner", "group", { group: "outer/in.ner" }]]);
  expect(shown([first], ["outer", "outer/other"])).toEqual([
    ["outer.other.u", "group outer.in.ner in the file", { element: "id of field" }],
  ]);
  expect(shown([], ["outer"])).toEqual([["outer.in.ner", "removed from the document", null]]);
});
