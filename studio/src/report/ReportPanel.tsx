// The panel of the import report: what became of every element, parameter and connection of the file of
// another tool. Lines of an element or a group lead to it.

import "./report.css";

import { TextInput } from "@mantine/core";
import { IconSearch, IconTrash } from "@tabler/icons-react";
import { type KeyboardEvent, useMemo, useState } from "react";

import { getStage } from "../actions/stage";
import { useOffline } from "../widgets/NeedsServer";
import { keyOf } from "../architecture/tree";
import { onCanvas } from "../actions/showGoal";
import type { ImportReportView } from "../protocol";
import { request } from "../server/socket";
import { useSame } from "../state/useSame";
import { useStudio } from "../server/store";
import { IconButton, PanelButton } from "../widgets/Buttons";
import { Segments } from "../widgets/Segments";
import { countOf, lossesText, type Present, type ReportFilter, reportItems } from "./reportItems";
import { ReportList } from "./ReportList";

export function ReportPanel() {
  const report = useStudio((state) => state.report);
  if (report === null) {
    return (
      <p className="report dim">
        This document was not made from a file of another tool, or does not contain the report of it.
      </p>
    );
  }
  // Another report starts with its own filter.
  return <Walk key={`${report.tool} ${report.file}`} report={report} />;
}

// More lines are shown on demand.
const MOST = 800;

function Walk({ report }: { report: ImportReportView }) {
  const present = usePresent();
  const offline = useOffline();
  const losses = countOf(report, "losses");
  const [filter, setFilter] = useState<ReportFilter>(losses > 0 ? "losses" : "all");
  const [search, setSearch] = useState("");
  const [most, setMost] = useState(MOST);
  const items = useMemo(
    () => reportItems(report, present, filter, search),
    [report, present, filter, search],
  );
  const count = items.reduce((sum, { lines }) => sum + lines.length, 0);
  return (
    <div className="report">
      <div>
        <div className="across">
          <span className="grow wrapped">
            <b>{report.file}</b> ({report.tool}): {summaryText(report)}
          </span>
          <IconButton
            icon={IconTrash}
            size={24}
            disabled={offline}
            label="Remove the report"
            tip="Remove the report from the document; undo brings it back"
            onClick={() => void removeReport()}
          />
        </div>
        <PanelButton
          label="Tidy to grid"
          disabled={offline}
          title="Compute places for all boxes instead of those of the file; undo brings these back"
          onClick={() => onCanvas(() => getStage()?.tidy())}
        />
        <div className="across report-controls">
          {losses > 0 && (
            <Segments
              label="Lines to show"
              value={filter}
              onChange={setFilter}
              options={{
                losses: `Not carried ${losses}`,
                approximated: `Approximated ${countOf(report, "approximated")}`,
                dropped: `Dropped ${countOf(report, "dropped")}`,
                all: `All ${countOf(report, "all")}`,
              }}
            />
          )}
          <TextInput
            size="xs"
            className="grow report-search"
            aria-label="Find in the report"
            placeholder="Find in the report"
            leftSection={<IconSearch size={14} aria-hidden />}
            value={search}
            onChange={(event) => setSearch(event.currentTarget.value)}
            onKeyDown={(event) => event.key === "ArrowDown" && focusLine(event)}
          />
        </div>
        {report.bugs.length > 0 && (
          <details className="report-bugs">
            <summary>
              Known errors of {report.tool} that the file touches: {report.bugs.length}
            </summary>
            <ul>
              {report.bugs.map((bug) => (
                <li key={bug}>{bug}</li>
              ))}
            </ul>
          </details>
        )}
      </div>
      {count === 0 && (
        <p className="dim" role="status">
          {search.trim() === "" ? "The report has no such lines." : "No line has these words."}
        </p>
      )}
      {count > 0 && <ReportList items={items} most={most} />}
      {count > most && (
        <PanelButton label={`Show ${count - most} more lines`} mt={6} onClick={() => setMost(count)} />
      )}
    </div>
  );
}

// The same as long as no element and no group is added, removed or renamed, whatever values change.
function usePresent(): Present {
  const paths = useSame((state) => [...state.elements.values()].map(({ id, path }) => [id, path] as const));
  const groups = useStudio((state) => state.document?.groups);
  return useMemo(() => ({ elements: new Map(paths), groups: new Set(groups?.map(keyOf)) }), [paths, groups]);
}

// From the search to the lines.
function focusLine(event: KeyboardEvent): void {
  event.preventDefault();
  const panel = event.currentTarget.closest(".report");
  panel?.querySelector<HTMLElement>("[role=option][tabindex='0']")?.focus();
}

// The report is an entry of the layout, which the server sends as a message of its own.
function removeReport(): Promise<unknown> {
  return request({ type: "arrange", layout: { import_report: null }, undoable: true });
}

function summaryText(report: ImportReportView): string {
  const [all, losses] = [countOf(report, "all"), lossesText(report)];
  return losses === ""
    ? `all ${all} items were carried`
    : `${all - countOf(report, "losses")} of ${all} items were carried, ${losses}`;
}
