// What a motor of a robot allows, in words.

import type { MotorLimits } from "../protocol";
import { numberText } from "../model/number";

export function motorText({ motor, lower, upper, slew, unit }: MotorLimits): string {
  const range = lower == null || upper == null ? "any value" : `${numberText(lower)} to ${numberText(upper)}`;
  const speed = slew == null ? "" : `, at most ${numberText(slew)} a second`;
  return `${motor}: ${[range, unit].filter(Boolean).join(" ")}${speed}`;
}
