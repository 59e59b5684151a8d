import { describe, expect, it } from "vitest";
import { History } from "../server/history";
import { firstAt, sideBySide } from "./series";

function history(...pairs: [number, number][]): History {
  const made = new History();
  made.times = pairs.map(([time]) => time);
  made.values = pairs.map(([, value]) => value);
  return made;
}

describe("time courses side by side", () => {
  it("share equal times", () => {
    expect(sideBySide([history([0, 1], [1, 2], [2, 3]), history([0, 4], [1, 5], [2, 6])], 2)).toEqual([
      [1, 2],
      [2, 3],
      [5, 6],
    ]);
  });

  it("have gaps at times that differ", () => {
    expect(sideBySide([history([0, 1], [2, 2]), history([1, 5], [2, 6])], 0)).toEqual([
      [0, 1, 2],
      [1, null, 2],
      [null, 5, 6],
    ]);
    expect(sideBySide([history([0, 1]), history()], 0)).toEqual([[0], [1], [null]]);
    expect(sideBySide([], 0)).toEqual([[]]);
  });

  it("begin one sample before the edge of the window", () => {
    expect(firstAt([0, 1, 2, 3], 2)).toBe(1);
    expect(firstAt([0, 1, 2, 3], 9)).toBe(3);
    expect(firstAt([], 1)).toBe(0);
  });
});
