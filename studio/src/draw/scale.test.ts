import { describe, expect, it } from "vitest";
import { CalmRange, round, ticks } from "./scale";

describe("ranges", () => {
  it("have round bounds", () => {
    expect(round([-5.13, 6.7])).toEqual([-6, 7]);
    expect(round([0, 1])).toEqual([0, 1]);
    expect(round([3, 3])[0]).toBeLessThan(3);
    expect(round([0, 0])).toEqual([-0.5, 0.5]);
  });

  it("grow at once", () => {
    const calm = new CalmRange();
    expect(calm.next([0, 1], [], 0)).toEqual([0, 1]);
    expect(calm.next([0, 4.2], [], 1)).toEqual([0, 4.2]);
    expect(calm.next([-3.9, 0], [], 2)).toEqual([-4, 4.2]);
  });

  it("shrink only after some seconds of smaller values", () => {
    const calm = new CalmRange();
    calm.next([0, 10], [], 0);
    expect(calm.next([0, 1], [], 100)).toEqual([0, 10]);
    expect(calm.next([0, 3], [], 2000)).toEqual([0, 10]);
    expect(calm.next([0, 1], [], 3200)).toEqual([0, 3]);
  });

  it("wait again after large values return", () => {
    const calm = new CalmRange();
    calm.next([0, 10], [], 0);
    calm.next([0, 1], [], 100);
    calm.next([0, 9], [], 2000);
    expect(calm.next([0, 1], [], 3200)).toEqual([0, 10]);
  });

  it("have a margin", () => {
    expect(new CalmRange(0.1).next([0, 5], [], 0)).toEqual([-0.5, 5.5]);
  });

  it("contain the levels", () => {
    expect(new CalmRange().next([-5, -4], [0], 0)).toEqual([-5, 0]);
    expect(new CalmRange().next(null, [], 0)).toEqual([0, 1]);
  });
});

describe("ticks", () => {
  it("are placed at round values", () => {
    expect(ticks([-5, 4], 4)).toEqual({ places: [-5, 0], step: 5 });
    expect(ticks([0, 1], 5).places).toEqual([0, 0.2, 0.4, 0.6, 0.8, 1]);
    expect(ticks([2, 2], 5).places).toEqual([2]);
  });
});
