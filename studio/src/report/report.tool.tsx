// The tool of the import report, which is loaded when it is first shown.

import { later } from "../widgets/Later";
import type { DockTool } from "../state/tool";

export const tool: DockTool = {
  title: "Import report",
  component: later(async () => (await import("./ReportPanel")).ReportPanel),
};
