// The tool of regimes, which is loaded when it is first shown.

import { later } from "../widgets/Later";
import type { DockTool } from "../state/tool";

export const tool: DockTool = {
  title: "Regime",
  tab: 3,
  component: later(async () => (await import("./RegimePanel")).RegimePanel),
};
