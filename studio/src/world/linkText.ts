// The link with a robot in words.

import type { RobotLink } from "../protocol";

export function linkText({ robot, age, lost, refused, round_trip }: RobotLink): string {
  const parts = [`last message ${((age ?? 0) / 1000).toFixed(1)} s ago`, `${lost ?? 0} lost`];
  if ((refused ?? 0) > 0) {
    parts.push(`${refused} refused`);
  }
  if ((round_trip ?? 0) > 0) {
    parts.push(`round trip ${(round_trip ?? 0).toFixed(1)} ms`);
  }
  return `${robot}: ${parts.join(", ")}`;
}
