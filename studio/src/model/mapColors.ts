// The colours of a plot whose values are colours: a scale, and the range that it covers.

import { activationScale, amounts, onBoth, scale, type ScaleName } from "./colors";
import type { MapColors } from "../draw/content";
import type { ColorTables } from "../draw/paint";
import { hasLevels } from "./ports";
import { type Level, thresholdOf } from "./levels";
import { extent, type Range } from "../draw/scale";
import type { Kind } from "../protocol";
import { CalmRange } from "../draw/scale";

// The colours of a port without the range that they cover. A scale with two sides has its middle at the
// threshold.
export type ColorScale = Readonly<{ tables: ColorTables; twoSided: boolean }>;

// A port that has levels has a scale with two sides.
export function scaleOf(chosen: ScaleName | "auto", kind: Kind | undefined, port: string): ColorScale {
  if (chosen === "auto" && !hasLevels(kind, port)) {
    return { tables: amounts(port), twoSided: false };
  }
  return chosenScale(chosen === "auto" ? "diverging" : chosen);
}

export function chosenScale(name: ScaleName): ColorScale {
  return { tables: scale(name), twoSided: name === "diverging" };
}

export function middleOf(twoSided: boolean, levels: Level[]): number | null {
  return twoSided ? (thresholdOf(levels) ?? 0) : null;
}

// Colours that follow the values calmly, or have a fixed range.
export class FollowingColors {
  now: MapColors = { range: [0, 1], middle: null, tables: scale("gray") };
  private calm = new CalmRange();
  private followed: ColorScale | null = null;

  // Return whether the colours changed.
  follow(values: ArrayLike<number>, scale: ColorScale, middle: number | null, fixed: Range | null): boolean {
    const range = fixed ?? this.calm.next(extent(values), middle === null ? [] : [middle], performance.now());
    const { now } = this;
    if (
      now.range[0] === range[0] &&
      now.range[1] === range[1] &&
      now.middle === middle &&
      this.followed?.tables === scale.tables
    ) {
      return false;
    }
    this.followed = scale;
    const tables = middle === null ? scale.tables : onBoth(activationScale(range[0], range[1], middle));
    this.now = { range, middle, tables };
    return true;
  }
}
