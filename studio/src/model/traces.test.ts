import { describe, expect, it } from "vitest";
import { timeRange } from "./traces";

describe("the time that is shown", () => {
  it("is fixed until the window is full, then scrolls", () => {
    expect(timeRange(0, 100, 500)).toEqual([0, 500]);
    expect(timeRange(0, 800, 500)).toEqual([300, 800]);
    expect(timeRange(20, 800, null)).toEqual([20, 800]);
    expect(timeRange(5, 5, null)).toEqual([5, 6]);
  });

  it("contains the moment of the past that the page shows", () => {
    expect(timeRange(0, 800, 200, 400)).toEqual([300, 500]);
    expect(timeRange(0, 800, 200, 780)).toEqual([600, 800]);
    expect(timeRange(0, 800, 200, 10)).toEqual([0, 200]);
    expect(timeRange(0, 800, null, 400)).toEqual([0, 800]);
  });
});
