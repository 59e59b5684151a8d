// The import report as the panel shows it: lines by the element that they belong to, under its present name.

import type { ImportReportView, ReportLineView } from "../protocol";

export const FILTERS = ["losses", "approximated", "dropped", "all"] as const;
export type ReportFilter = (typeof FILTERS)[number];

export type ReportLine = ReportLineView & { key: string };

export type ReportItem = {
  key: string;
  // The element that its lines lead to; null where the document has none.
  element: string | null;
  title: string;
  // What the name in the file was, or why its lines lead nowhere.
  note: string;
  lines: ReportLine[];
};

// The present paths of elements by their ids.
export type ElementPaths = ReadonlyMap<string, string>;

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
  paths: ElementPaths,
  filter: ReportFilter,
  search: string,
): ReportItem[] {
  const words = search
    .toLowerCase()
    .split(/\s+/)
    .filter((word) => word !== "");
  const items = new Map<string, ReportItem>();
  report.lines.forEach((line, i) => {
    const item = items.get(line.where) ?? itemFor(line, paths);
    const { part, what, verdict, why } = line;
    const text = `${item.title} ${line.where} ${part} ${what} ${verdict} ${why}`.toLowerCase();
    if (passes(line, filter) && words.every((word) => text.includes(word))) {
      item.lines.push({ ...line, key: String(i) });
      items.set(line.where, item);
    }
  });
  return [...items.values()];
}

function itemFor({ where, element }: ReportLineView, paths: ElementPaths): ReportItem {
  const path = paths.get(element);
  if (path === undefined) {
    const title = where === "" ? FILE : where;
    return { key: where, element: null, title, note: absence(where, element), lines: [] };
  }
  const note = path === where ? "" : `${where} in the file`;
  return { key: where, element, title: path, note, lines: [] };
}

function absence(where: string, element: string): string {
  if (element !== "") {
    return "removed from the document";
  }
  return where === "" ? "" : "no element of the document";
}
