// What the page shows after all panels were closed.

import { PanelMenu } from "./PanelMenu";

export function Empty() {
  return (
    <div className="dock-empty">
      <p>No panel is open.</p>
      <PanelMenu />
    </div>
  );
}
