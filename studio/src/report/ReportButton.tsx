// How much of the file of another tool was not carried; a click opens the report. Absent without losses.

import { Button } from "@mantine/core";
import { IconFileImport } from "@tabler/icons-react";

import { openTool } from "../state/tool";
import { useStudio } from "../server/store";
import { countOf, lossesText } from "./reportItems";

export function ReportButton() {
  const report = useStudio((state) => state.report);
  const losses = report === null ? 0 : countOf(report, "losses");
  if (report === null || losses === 0) {
    return null;
  }
  const label = `Import report: ${losses} not carried (${lossesText(report)})`;
  return (
    <Button
      size="compact-sm"
      variant="default"
      px={7}
      leftSection={<IconFileImport size={15} color="var(--warn)" />}
      aria-label={label}
      title={label}
      onClick={() => openTool("report")}
    >
      {losses}
    </Button>
  );
}
