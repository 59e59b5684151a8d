// The link with a robot in another process: a line in the panel of the world, and the stop in the foot of the
// page.

import { Button } from "@mantine/core";
import { useSyncExternalStore } from "react";

import { linkText } from "./linkText";
import { live } from "./live";
import { stopRobot } from "./robotStop";

export function LinkState() {
  const link = useSyncExternalStore(live.listen, live.link);
  if (link === null) {
    return null;
  }
  return (
    <div className="world-link">
      <span className="one-line numbers">{linkText(link)}</span>
    </div>
  );
}

export function StopButton() {
  const connected = useSyncExternalStore(live.listen, () => live.link() !== null);
  return (
    connected && (
      <Button size="compact-md" color="red" title="Stop the robot (Escape)" onClick={() => void stopRobot()}>
        Stop
      </Button>
    )
  );
}
