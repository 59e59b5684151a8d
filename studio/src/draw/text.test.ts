import { describe, expect, it } from "vitest";
import { reading, short, tick, timeText, writtenTime } from "./text";

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
});

describe("times", () => {
  it("are in seconds to the thousandth, above 1000 s to the tenth", () => {
    expect(timeText(1090, "ms")).toBe("1.090 s");
    expect(timeText(109_000, "ms")).toBe("109.000 s");
    expect(timeText(999_999, "ms")).toBe("999.999 s");
    expect(timeText(12_345_678, "ms")).toBe("12\u2009345.7 s");
    expect(timeText(-2, "min")).toBe("\u2212120.000 s");
  });

  it("in a unit of the document's own are written as they are", () => {
    expect(timeText(12.5, "abstract")).toBe("12.500");
    expect(timeText(109_000, "1 = 64 ms")).toBe("109\u2009000.0");
    expect(writtenTime("abstract")).toEqual({ factor: 1, unit: "abstract" });
  });
});
