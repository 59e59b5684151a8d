// What a plot keeps from one picture to the next: ranges that follow the values calmly.

import type { MapColors } from "../../draw/content";
import { CalmRange, type Range } from "../../draw/scale";
import { type ColorScale, FollowingColors, middleOf } from "../../model/mapColors";
import type { Level } from "../../model/levels";

const ROOM = 0.03;

type Wanted = { include?: number[]; fixed?: Range | null; side?: "x" | "y" };

export class Memory {
  // The range of values, or of colours, that was shown last.
  range: Range = [0, 1];
  private sides = { x: new CalmRange(ROOM), y: new CalmRange(ROOM) };
  private following = new FollowingColors();

  constructor(private now: () => number = () => performance.now()) {}

  // A range around values, and around those to include; a fixed one if there is one.
  around(extent: Range | null, { include = [], fixed = null, side = "y" }: Wanted = {}): Range {
    const range = fixed ?? this.sides[side].next(extent, include, this.now());
    if (side === "y") {
      this.range = range;
    }
    return range;
  }

  colors(values: ArrayLike<number>, scale: ColorScale, levels: Level[], fixed: Range | null): MapColors {
    this.following.follow(values, scale, middleOf(scale.twoSided, levels), fixed);
    this.range = this.following.now.range;
    return this.following.now;
  }
}
