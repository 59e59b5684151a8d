// The link with a robot in another process: a line in the panel of the world, and its stop with what the
// motors allow: a button in the foot of the page, and the key Escape everywhere. The run pauses; the server
// then puts the motors to rest, and they get no more commands.

import "./world.css";

import { Button, Popover } from "@mantine/core";
import { useEffect, useSyncExternalStore } from "react";

import { linkText } from "./linkText";
import { live } from "../server/live";
import { motorText } from "./motorText";
import { NarrowMotors } from "./NarrowMotors";
import type { Answer } from "../protocol";
import { request, socket } from "../server/socket";

export function LinkState() {
  const link = useSyncExternalStore(live.listen, live.link);
  if (link === null) {
    return null;
  }
  return (
    <div className="flow world-link">
      <span className="one-line numbers">{linkText(link)}</span>
    </div>
  );
}

// How many motors are named beside the stop.
const MOST_NAMED = 3;

export function StopButton() {
  const link = useSyncExternalStore(live.listen, live.link);
  if (link === null) {
    return null;
  }
  const { motors = [], can_narrow = false } = link;
  const named = motors.length > MOST_NAMED ? motors.slice(0, MOST_NAMED - 1) : motors;
  return (
    <div className="robot-stop">
      <Button
        size="compact-md"
        color="#b3261e"
        title="Stop the robot (Escape)"
        onClick={() => void stopRobot()}
      >
        Stop
      </Button>
      {motors.length > 0 && (
        <Popover position="top-start" width={390} shadow="md" trapFocus returnFocus>
          <Popover.Target>
            <button type="button" className="robot-motors numbers" title={motors.map(motorText).join("\n")}>
              {named.map((motor) => (
                <span key={motor.motor} className="one-line">
                  {motorText(motor)}
                </span>
              ))}
              {named.length < motors.length && <span>and {motors.length - named.length} more motors</span>}
            </button>
          </Popover.Target>
          <Popover.Dropdown aria-label="Limits of the motors">
            <p className="dim">
              {can_narrow
                ? "Each number can be made narrower, from the next command on."
                : "The robot states these limits; they cannot be narrowed here."}
            </p>
            {can_narrow ? (
              <NarrowMotors
                motors={motors}
                set={
                  (limits) =>
                    (limits.lower == null) === (limits.upper == null)
                      ? socket.ask({ type: "narrow_motor", limits })
                      : undefined // the other end of the range follows
                }
              />
            ) : (
              motors.map((motor) => <p key={motor.motor}>{motorText(motor)}</p>)
            )}
          </Popover.Dropdown>
        </Popover>
      )}
    </div>
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
