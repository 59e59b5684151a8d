// The import report as the panel shows it: lines by the element that they belong to, under its present name.

import { keyOf } from "../architecture/tree";
import type { CanvasGoal } from "../actions/showGoal";
import { hasWords } from "../model/values";
import type { ImportReportView, ReportLineView } from "../protocol";

export type ReportFilter = "losses" | "approximated" | "dropped" | "all";

export type ReportLine = ReportLineView & { key: string };

export type ReportItem = {
  key: string;
  // What its lines lead to; null where the document has none.
  goal: CanvasGoal | null;
  title: string;
  // What the name in the file was, or why its lines lead nowhere.
  note: string;
  lines: ReportLine[];
};

// The present paths of elements by their ids, and the keys of the present groups.
export type Present = { elements: ReadonlyMap<string, string>; groups: ReadonlySet<string> };

const FILE = "The file as a whole";

export function isLoss({ verdict }: ReportLineView): boolean {
  return verdict !== "carried";
}

function passes(line: ReportLineView, filter: ReportFilter): boolean {
  return filter === "all" || (filter === "losses" ? isLoss(line) : line.verdict === filter);
}

export function countOf(report: ImportReportView, filter: ReportFilter): number {
  return report.lines.filter((line) => passes(line, filter)).length;
}

// "1 approximated, 2 dropped"; empty if everything was carried.
export function lossesText(report: ImportReportView): string {
  return (["approximated", "dropped"] as const)
    .map((verdict) => ({ verdict, n: countOf(report, verdict) }))
    .filter(({ n }) => n > 0)
    .map(({ verdict, n }) => `${n} ${verdict}`)
    .join(", ");
}

// Every word of a search must occur in a line, or in the name of its element, now or in the file.
export function reportItems(
  report: ImportReportView,
  present: Present,
  filter: ReportFilter,
  search: string,
): ReportItem[] {
  const items = new Map<string, ReportItem>();
  report.lines.forEach((line, i) => {
    const item = items.get(line.where) ?? itemFor(line, present);
    const { part, what, verdict, why } = line;
    const text = `${item.title} ${line.where} ${part} ${what} ${verdict} ${why}`;
    if (passes(line, filter) && hasWords(text, search)) {
      item.lines.push({ ...line, key: String(i) });
      items.set(line.where, item);
    }
  });
  return [...items.values()];
}

// Groups have no ids: a group of the name in the file is found again, and of a renamed or moved one the first
// element that it had.
function itemFor({ where, element, group }: ReportLineView, { elements, groups }: Present): ReportItem {
  const [key, path] = [keyOf(group), elements.get(element)];
  if (group.length > 0 && groups.has(key)) {
    return { key: where, goal: { group: key }, title: where, note: "group", lines: [] };
  }
  if (path === undefined) {
    const title = where === "" ? FILE : where;
    const gone = element !== "" || group.length > 0;
    return { key: where, goal: null, title, note: absence(where, gone), lines: [] };
  }
  const sort = group.length > 0 ? "group " : "";
  const note = sort + (path === where ? "" : `${where} in the file`);
  return { key: where, goal: { element }, title: path, note, lines: [] };
}

function absence(where: string, gone: boolean): string {
  if (gone) {
    return "removed from the document";
  }
  return where === "" ? "" : "no element of the document";
}
