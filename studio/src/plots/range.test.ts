import { describe, expect, it } from "vitest";
import { CalmRange, reading, round, short, tick, ticks } from "./range";

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

describe("numbers", () => {
  it("on ticks have the digits of the step", () => {
    expect(tick(2.5, 2.5)).toBe("2.5");
    expect(tick(0.25, 0.25)).toBe("0.25");
    expect(tick(-5, 1)).toBe("\u22125");
    expect(tick(0.30000000000000004, 0.1)).toBe("0.3");
    expect(tick(-0.0000001, 0.5)).toBe("0.0");
    expect(tick(2_000_000, 1_000_000)).toBe("2.0e+6");
  });

  it("are displayed with about three digits", () => {
    expect(reading(123.456)).toBe("123.5");
    expect(reading(-1.23456)).toBe("\u22121.235");
    expect(reading(0)).toBe("0.000");
    expect(reading(1.5e-7)).toBe("1.50e\u22127");
    expect(short(-5)).toBe("\u22125");
    expect(short(0.123456)).toBe("0.1235");
  });

  it("are placed at round values", () => {
    expect(ticks([-5, 4], 4)).toEqual({ places: [-5, 0], step: 5 });
    expect(ticks([0, 1], 5).places).toEqual([0, 0.2, 0.4, 0.6, 0.8, 1]);
    expect(ticks([2, 2], 5).places).toEqual([2]);
  });
});
