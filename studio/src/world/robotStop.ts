// The stop of a robot in another process: a button in the foot of the page, and the key Escape everywhere.
// The run pauses; the server then puts the motors to rest, and they get no more commands.

import { useEffect } from "react";

import type { Answer } from "../protocol";
import { request } from "../socket";
import { live } from "./live";

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
