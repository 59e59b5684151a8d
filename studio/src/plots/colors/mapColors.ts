// The colours of a plot whose values are colours: a scale, and the range that it covers.

import { activationScale, scale, type ScaleName } from "./colors";
import type { MapColors } from "../../draw/content";
import { hasLevels } from "../../model/ports";
import { type Level, thresholdOf } from "../levels";
import { extent, type Range } from "../../draw/scale";
import type { Kind } from "../../protocol";
import { CalmRange } from "../../draw/scale";

type NamedColors = MapColors & { name: ScaleName };

// How a port is coloured: by a scale with two sides, whose middle is the threshold, if it has levels.
export function scaleOf(
  chosen: ScaleName | "auto",
  kind: Kind | undefined,
  port: string,
): { name: ScaleName; twoSided: boolean } {
  const twoSided = chosen === "diverging" || (chosen === "auto" && hasLevels(kind, port));
  return { name: chosen !== "auto" ? chosen : twoSided ? "diverging" : "viridis", twoSided };
}

export function middleOf(twoSided: boolean, levels: Level[]): number | null {
  return twoSided ? (thresholdOf(levels) ?? 0) : null;
}

// Colours that follow the values calmly, or have a fixed range.
export class FollowingColors {
  now: NamedColors;
  private calm = new CalmRange();

  constructor(name: ScaleName) {
    this.now = { name, range: [0, 1], middle: null, table: scale(name) };
  }

  // Return whether the colours changed.
  follow(values: ArrayLike<number>, name: ScaleName, middle: number | null, fixed: Range | null): boolean {
    const range = fixed ?? this.calm.next(extent(values), middle === null ? [] : [middle], performance.now());
    const { now } = this;
    if (
      now.range[0] === range[0] &&
      now.range[1] === range[1] &&
      now.middle === middle &&
      now.name === name
    ) {
      return false;
    }
    const table = middle === null ? scale(name) : activationScale(range[0], range[1], middle);
    this.now = { name, range, middle, table };
    return true;
  }
}
