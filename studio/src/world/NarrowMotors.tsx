// The limits of the motors of a robot as numbers, which a person makes narrower.

import { useState } from "react";

import type { MotorLimits } from "../protocol";
import type { Reply } from "../server/socket";
import { NumberField } from "../widgets/NumberField";

type NarrowMotorsProps = {
  motors: MotorLimits[];
  set: (limits: MotorLimits) => void | Promise<Reply>;
};

// What was typed is shown until the server has answered; where `set` does not ask it, as long as the form is
// there.
export function NarrowMotors({ motors, set }: NarrowMotorsProps) {
  const [drafts, setDrafts] = useState<Record<string, MotorLimits>>({});
  const change = async (limits: MotorLimits) => {
    setDrafts((before) => ({ ...before, [limits.motor]: limits }));
    const reply = await set(limits);
    if (reply !== undefined) {
      setDrafts(({ [limits.motor]: _, ...others }) => others);
    }
    return reply;
  };
  return motors.map((motor) => {
    const { lower, upper, slew, unit = "" } = motor;
    const shown = drafts[motor.motor] ?? motor;
    const range = { lower: lower ?? undefined, upper: upper ?? undefined, unit };
    const named = (text: string) => `${motor.motor}, ${text}`;
    return (
      <div key={motor.motor} className="motor-limits" role="group" aria-label={motor.motor}>
        <NumberField
          {...range}
          label={named("from")}
          value={shown.lower ?? null}
          set={(typed) => change({ ...shown, lower: typed }) as Promise<Reply>}
        />
        <NumberField
          {...range}
          label={named("to")}
          value={shown.upper ?? null}
          set={(typed) => change({ ...shown, upper: typed }) as Promise<Reply>}
        />
        <NumberField
          lower={0}
          upper={slew ?? undefined}
          label="change a second"
          value={shown.slew ?? null}
          set={(typed) => change({ ...shown, slew: typed }) as Promise<Reply>}
        />
      </div>
    );
  });
}
