// The link with a robot in another process: a line in the panel of the world, and its stop: a button in the
// foot of the page, and the key Escape everywhere. The run pauses; the server then puts the motors to rest,
// and they get no more commands.

import { Button } from "@mantine/core";
import { useEffect, useSyncExternalStore } from "react";

import { linkText } from "./linkText";
import { live } from "./live";
import type { Answer } from "../protocol";
import { request } from "../socket";

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

// Also where the run seems to be paused: the page may not know yet that it runs.
export function stopRobot(): Promise<Answer> | void {
  if (live.link() !== null) {
    return request({ type: "pause" });
  }
}

// Whatever else the key does, in a text or a dialog, the robot stops first.
export function useRobotStop(): void {
  useEffect(() => {
    const onPress = (event: KeyboardEvent) => void (event.key === "Escape" && stopRobot());
    addEventListener("keydown", onPress, { capture: true });
    return () => removeEventListener("keydown", onPress, { capture: true });
  }, []);
}
