import { describe, expect, it } from "vitest";

import { played, thinnedShare } from "./playback";

const span = { first: 0, last: 1000, second: 1000 };

describe("playing", () => {
  it("moves by wall time times speed, in either direction", () => {
    expect(played(500, 20, { direction: 1, speed: 1 }, span)).toEqual({ time: 520, ended: false });
    expect(played(500, 20, { direction: -1, speed: 2 }, span)).toEqual({ time: 460, ended: false });
    expect(played(0, 20, { direction: 1, speed: 0.5 }, { ...span, second: 50 }).time).toBe(0.5);
  });

  it("ends at the first and at the last moment", () => {
    expect(played(995, 20, { direction: 1, speed: 1 }, span)).toEqual({ time: 1000, ended: true });
    expect(played(5, 20, { direction: -1, speed: 1 }, span)).toEqual({ time: 0, ended: true });
  });

  it("does not jump after the page was hidden", () => {
    expect(played(0, 60_000, { direction: 1, speed: 1 }, span).time).toBe(100);
  });
});

it("the thinned part is a share of the time covered", () => {
  const view = { ...span, full_from: 250, frames: 10, frame: 0, time: null, step: 1 };
  expect(thinnedShare(view)).toBe(0.25);
  expect(thinnedShare({ ...view, last: 0, full_from: 0 })).toBe(0);
});
