// The line of the panel of the world about the link with a robot in another process, and its stop.

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
      <Button size="compact-xs" color="red" title="Stop the robot (Escape)" onClick={() => void stopRobot()}>
        Stop
      </Button>
    </div>
  );
}
